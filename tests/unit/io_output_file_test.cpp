// SPDX-License-Identifier: Apache-2.0
//
// A file appears whole or not at all: also when the disk is full, the folder is missing, or the
// target is something that must not be replaced.
#include <sys/resource.h>

#include <csignal>
#include <random>

#include "io/output_file.h"
#include "io/png.h"
#include "support/io_files.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace pierce::io {
namespace {

std::string error(const std::filesystem::path& path) {
  return error_of([&] { OutputFile file(path); });
}

// The limit of a file's size plays the full disk: writing beyond it fails.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    (void)std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_ = {};
  void (*handler_)(int);
};

TEST(IoOutputFile, appears_when_committed_and_replaces_what_was_there) {
  const TempFolder folder;
  const auto path = folder.write("o", "before");
  OutputFile file(path);
  file.write("hello ");
  file.write(std::string(3'000'000, 'x'));
  file.write("end");
  file.rewrite(0, "H");
  EXPECT_EQ(contents(path), "before");
  file.commit();
  EXPECT_EQ(contents(path), "Hello " + std::string(3'000'000, 'x') + "end");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(IoOutputFile, two_writers_of_one_name_do_not_mix) {
  const TempFolder folder;
  OutputFile a(folder / "o");
  OutputFile b(folder / "o");
  a.write("aa");
  b.write("b");
  a.commit();
  b.commit();
  EXPECT_EQ(contents(folder / "o"), "b");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(IoOutputFile, a_full_disk_is_told_and_nothing_is_left) {
  const TempFolder folder;
  const std::string path = (folder / "o").string();
  {
    const SmallDisk disk(1'000'000);
    EXPECT_EQ(error_of([&] {
                OutputFile file(path);
                file.write(std::string(500'000, 'x'));
                file.write(std::string(600'000, 'x'));
                file.commit();
              }),
              path + ": cannot be written: File too large: free some space or write elsewhere");
  }
  EXPECT_EQ(folder.files(), 0u);
}

TEST(IoOutputFile, a_program_that_ends_in_a_hurry_leaves_nothing) {
  const TempFolder folder;
  const auto hurry = [&] {
    OutputFile begun(folder / "begun"), another(folder / "another"), done(folder / "done");
    begun.write("half");
    done.commit();
    abandon_output_files();
    ::_exit(7);
  };
  EXPECT_EXIT(hurry(), testing::ExitedWithCode(7), "");
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_TRUE(std::filesystem::exists(folder / "done"));
}

TEST(IoOutputFile, a_link_is_followed) {
  const TempFolder folder;
  (void)folder.write("real", "before");
  std::filesystem::create_symlink("real", folder / "link");
  OutputFile file(folder / "link");
  file.write("after");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(contents(folder / "real"), "after");
}

TEST(IoOutputFile, a_link_to_what_does_not_exist_yet_is_followed) {
  const TempFolder folder;
  std::filesystem::create_symlink("new", folder / "link");
  std::filesystem::create_symlink("link", folder / "far link");
  OutputFile file(folder / "far link");
  file.write("text");
  file.commit();
  EXPECT_EQ(contents(folder / "new"), "text");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));

  std::filesystem::create_symlink("circle", folder / "circle");
  const std::string circle = (folder / "circle").string();
  EXPECT_EQ(error(circle), circle +
                               ": cannot be written: Too many levels of symbolic links: its links "
                               "lead in a circle, name a file");
}

TEST(IoOutputFile, names_may_be_as_long_as_the_file_system_allows) {
  const TempFolder folder;
  const std::string name(255, 'n');
  OutputFile file(folder / name);
  file.commit();
  EXPECT_TRUE(std::filesystem::exists(folder / name));
  const std::string longer = (folder / (name + "n")).string();
  EXPECT_EQ(error(longer),
            longer + ": cannot be written: File name too long: choose a shorter name");
}

TEST(IoOutputFile, what_must_not_be_replaced_is_refused) {
  const TempFolder folder;
  EXPECT_EQ(error("/dev/null"), "/dev/null: is a pipe or a device: name an ordinary file");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  const std::string here = (folder / "").string();
  EXPECT_EQ(error(here), here + ": is a folder: name a file in it");
  const std::string deep = (folder / "no/such/o").string();
  EXPECT_EQ(error(deep),
            deep + ": cannot be written: No such file or directory: make its folder first");
}

TEST(IoPng, pixels_come_back_as_they_went) {
  const TempFolder folder;
  std::mt19937 random(1);
  std::vector<std::uint8_t> rgb(37 * 11 * 3);
  for (std::uint8_t& byte : rgb) byte = static_cast<std::uint8_t>(random());
  write_png(folder / "p.png", 37, 11, rgb);
  const std::string png = contents(folder / "p.png");
  int width = 0, height = 0, channels = 0;
  stbi_uc* const pixels =
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                            static_cast<int>(png.size()), &width, &height, &channels, 0);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 37);
  EXPECT_EQ(height, 11);
  EXPECT_EQ(channels, 3);
  EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + rgb.size()), rgb);
  stbi_image_free(pixels);
}

TEST(IoPng, wrong_sizes_are_refused) {
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_EQ(error_of([&] { write_png("p.png", 2, 3, rgb); }, ErrorCode::SizeMismatch),
            "a picture of 2 x 3 pixels has 18 bytes, not 12");
  EXPECT_NE(error_of([&] { write_png("p.png", 0, 3, {}); }, ErrorCode::SizeMismatch), "");
}

}  // namespace
}  // namespace pierce::io

// SPDX-License-Identifier: Apache-2.0
#include "io/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>

#include "io/bad_file.h"
#include "io/extension.h"
#include "io/packed.h"

namespace pierce::io {

struct ZipArchive::Handle {
  zip_t* zip = nullptr;
  ~Handle() {
    if (zip != nullptr) zip_discard(zip);
  }
};

ZipArchive::ZipArchive(std::string_view bytes, const std::string& name)
    : handle_(std::make_unique<Handle>()), name_(name), left_(unpacked_limit(bytes.size())) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (source != nullptr) {
    handle_->zip = zip_open_from_source(source, ZIP_RDONLY, &error);
    if (handle_->zip == nullptr) zip_source_free(source);
  }
  const std::string trouble = zip_error_strerror(&error);
  zip_error_fini(&error);
  if (handle_->zip == nullptr) {
    bad_file(name, fmt::format("is no ZIP archive that can be read ({}): get it again",
                               in_quotes(trouble, 100)));
  }
}

ZipArchive::~ZipArchive() = default;

std::vector<std::string> ZipArchive::members() const {
  std::vector<std::string> names;
  const zip_int64_t count = zip_get_num_entries(handle_->zip, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const member = zip_get_name(handle_->zip, static_cast<zip_uint64_t>(i), 0);
    if (member != nullptr) names.emplace_back(member);
  }
  return names;
}

bool ZipArchive::has(const std::string& member) const {
  return zip_name_locate(handle_->zip, member.c_str(), ZIP_FL_NOCASE) >= 0;
}

std::string ZipArchive::read(const std::string& member) {
  const auto fail = [&](const std::string& trouble) {
    bad_file(name_, fmt::format("its member {} cannot be read ({}): get the file again",
                                in_quotes(member, 100), in_quotes(trouble, 100)));
  };
  const zip_int64_t index = zip_name_locate(handle_->zip, member.c_str(), ZIP_FL_NOCASE);
  zip_file_t* const file =
      index < 0 ? nullptr : zip_fopen_index(handle_->zip, static_cast<zip_uint64_t>(index), 0);
  if (file == nullptr) fail(index < 0 ? "it is not there" : zip_strerror(handle_->zip));
  // What the archive says of the size is not believed.
  std::string out;
  std::string trouble;
  std::size_t used = 0;
  while (true) {
    if (used == out.size() && !grow_unpacked(out, used, left_)) break;
    const zip_int64_t got = zip_fread(file, out.data() + used, out.size() - used);
    if (got < 0) trouble = zip_file_strerror(file);
    if (got <= 0) break;
    used += static_cast<std::size_t>(got);
  }
  zip_fclose(file);
  if (!trouble.empty()) fail(trouble);
  if (used > left_) {
    bad_file(name_, fmt::format("its member {} unpacks to more than {} bytes: if that is right, {}",
                                in_quotes(member, 100), left_,
                                has_extension(name_, ".npz") ? "save what is in it as .npy"
                                                             : "save the mesh as PLY"));
  }
  left_ -= used;
  out.resize(used);
  return out;
}

}  // namespace pierce::io

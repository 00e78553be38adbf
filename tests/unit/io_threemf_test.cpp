// SPDX-License-Identifier: Apache-2.0
//
// 3MF: builds, components in other parts, transforms, units; exact numbers; refusals with the line.
#include <zip.h>

#include <utility>

#include "io/read_mesh.h"
#include "io/split_parts.h"
#include "pierce/transform.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

using Points = std::vector<Vec3<double>>;
using Triangles = std::vector<Triangle>;
using Members = std::vector<std::pair<std::string, std::string>>;

constexpr const char* kMesh =
    R"(<mesh><vertices><vertex x="0.1" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x=" 0 " y="1e0" z="-0.30000000000000004"/></vertices>
<triangles><triangle v1="0" v2="1" v3="2" pid="1"/></triangles></mesh>)";

std::string model(const std::string& resources, const std::string& build,
                  const std::string& attributes = {}) {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
 xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" )" +
         attributes + "><metadata name=\"x\">y</metadata><resources>" + resources +
         "</resources><build>" + build + "</build></model>";
}
std::string object(const std::string& id, const std::string& inside) {
  return "<object id=\"" + id + "\" name=\"part " + id + "\">" + inside + "</object>";
}

const char* const kRelationships =
    R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/Metadata/thumbnail.png" Id="r1"
 Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
<Relationship Target="/3D/Main.model" Id="r0"
 Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";

class Package {
 public:
  std::filesystem::path write(const Members& members, bool packed = true) {
    const std::filesystem::path path = folder_ / (std::to_string(++count_) + ".3mf");
    int error = 0;
    zip_t* const zip = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    for (const auto& [name, text] : members) {
      zip_source_t* const source = zip_source_buffer(zip, text.data(), text.size(), 0);
      const zip_int64_t at = zip_file_add(zip, name.c_str(), source, 0);
      const zip_int32_t how = packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE;
      zip_set_file_compression(zip, static_cast<zip_uint64_t>(at), how, 0);
    }
    zip_close(zip);
    return path;
  }
  Mesh read(const std::string& root, Members more = {}) {
    more.emplace_back("_rels/.rels", kRelationships);
    more.emplace_back("3D/Main.model", root);
    return read_mesh(write(more));
  }
  std::string refusal(const std::string& root, const Members& more = {}) {
    return error_of([&] { (void)read(root, more); });
  }

 private:
  TempFolder folder_;
  int count_ = 0;
};

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(IoThreemf, numbers_are_the_nearest_doubles) {
  Package package;
  const std::string root = model(object("1", kMesh), R"(<item objectid="1"/>)");
  const Points want = {{0.1, 0, 0}, {1, 0, 0}, {0, 1, -0.30000000000000004}};
  for (const bool packed : {true, false}) {
    const Mesh mesh = read_mesh(package.write({{"3D/3dmodel.model", root}}, packed));
    EXPECT_EQ(mesh.vertices, want);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_FALSE(mesh.single_precision);
    EXPECT_EQ(mesh.format, "3MF, unit millimeter");
  }
  EXPECT_EQ(package.read(root).vertices, want);  // by its relationship
}

TEST(IoThreemf, items_stand_where_their_transforms_say) {
  Package package;
  const Mesh mesh = package.read(model(object("1", kMesh), R"(<item objectid="1"/>
<item objectid="1" transform="0.1 0.2 0.3 0.7 0.11 0.13 0.17 0.19 0.23 1e-17 0.3 5"/>
<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 10 0 0"/>)"));
  const Transform<double> turn{
      {{{0.1, 0.7, 0.17, 1e-17}, {0.2, 0.11, 0.19, 0.3}, {0.3, 0.13, 0.23, 5}}}};
  ASSERT_EQ(mesh.vertices.size(), 9u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.vertices[3 + i], transformed(turn, mesh.vertices[i]));
  }
  EXPECT_EQ(mesh.vertices[7], (Vec3<double>{9, 0, 0}));
  EXPECT_EQ(mesh.triangles[2], (Triangle{6, 8, 7}));  // mirrored: the outside stays outside
  EXPECT_EQ(split_parts(mesh).size(), 3u);
  EXPECT_EQ(split_parts(mesh)[1].name, "part 1");
}

TEST(IoThreemf, components_may_lie_in_other_parts_and_units) {
  Package package;
  const std::string inner = model(object("7", kMesh), "");
  std::string inches = inner;
  inches.replace(inches.find("millimeter"), 10, "inch");
  const std::string root =
      model(object("1", R"(<components><component objectid="7" p:path="/3D/Objects/a.model"
 transform="1 0 0 0 1 0 0 0 1 0 0 1"/><component objectid="7" p:path="/3D/objects/B.model"/>
</components>)"),
            R"(<item objectid="1" p:UUID="u" transform="2 0 0 0 2 0 0 0 2 0 0 0"/>
<item objectid="7" p:path="/3D/Objects/a.model"/>)",
            "requiredextensions=\"p m\"");
  const Mesh mesh =
      package.read(root, {{"3D/Objects/a.model", inner}, {"3D/Objects/b.model", inches}});
  ASSERT_EQ(mesh.vertices.size(), 9u);
  EXPECT_EQ(mesh.vertices[1], (Vec3<double>{2, 0, 2}));
  EXPECT_EQ(mesh.vertices[4], (Vec3<double>{2 * 25.4, 0, 0}));
  EXPECT_EQ(mesh.vertices[7], (Vec3<double>{1, 0, 0}));
  expect_in(package.refusal(root, {{"3D/Objects/a.model", inner}}), "there is no part");
}

TEST(IoThreemf, what_is_beside_the_mesh_is_stepped_over) {
  Package package;
  const Mesh mesh = package.read(
      model("<m:colorgroup id=\"9\"><m:color color=\"#ff0000\"/></m:colorgroup>"
            "<basematerials id=\"8\"><base name=\"x\" displaycolor=\"#fff\"/></basematerials>" +
                object("1", std::string(kMesh).insert(6,
                                                      "<b:beamlattice><vertex x=\"9\"/>"
                                                      "</b:beamlattice>")),
            R"(<item objectid="1"/>)"));
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(IoThreemf, what_is_no_part_of_the_model_is_told) {
  Package package;
  const std::string aid = R"(<object id="2" type="other">)" + std::string(kMesh) + "</object>";
  const std::string both = R"(<item objectid="1"/><item objectid="2"/>)";
  const Mesh mesh = package.read(model(object("1", kMesh) + aid, both));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  ASSERT_EQ(mesh.warnings.size(), 1u);
  expect_in(mesh.warnings[0], "1 object of type 'support' or 'other'");
  expect_in(package.read(model(object("1", kMesh) + aid, "")).warnings[0],
            "its build is empty: it places none of its 2 objects");
  std::string old = model(object("1", kMesh), both);
  old.replace(old.find("core/2015/02"), 12, "2013/01");
  expect_in(package.refusal(old),
            "Main.model:2: the root is 'model' of "
            "'http://schemas.microsoft.com/3dmanufacturing/2013/01'");
}

TEST(IoThreemf, refusals_name_part_and_line) {
  Package package;
  const std::string item = R"(<item objectid="1"/>)";
  const auto with_mesh = [&](const std::string& from, const std::string& to) {
    std::string mesh = kMesh;
    mesh.replace(mesh.find(from), from.size(), to);
    return package.refusal(model(object("1", mesh), item));
  };
  expect_in(with_mesh("v3=\"2\"", "v3=\"3\""),
            "3D/Main.model:7: v3 '3' names no vertex, there are 3");
  expect_in(with_mesh("v3=\"2\"", "v3=\"-1\""), "names no vertex");
  expect_in(with_mesh("v3=\"2\"", ""), "'triangle' without v3");
  expect_in(with_mesh("x=\"0.1\"", "x=\"0,1\""), "x is '0,1'");
  expect_in(with_mesh("x=\"0.1\"", "x=\"1e999\""), "x is '1e999'");
  expect_in(with_mesh("<mesh>", "<mesh"), "is not well-formed XML");
  const std::string mesh = object("1", kMesh);
  expect_in(package.refusal(model(mesh, R"(<item objectid="2"/>)")), "there is no object '2'");
  expect_in(package.refusal(model(mesh, R"(<item objectid="1" transform="1 0 0"/>)")),
            "12 numbers");
  expect_in(package.refusal(model(mesh + mesh, item)), "a second object '1'");
  expect_in(package.refusal(model(mesh, item, "requiredextensions=\"b\"")), "beamlattice/2017/02");
  expect_in(package.refusal(model(mesh, item, "requiredextensions=\"zz\"")), "'zz'");
  expect_in(package.refusal(
                model(object("1", R"(<components><component objectid="1"/></components>)"), item)),
            "circle");
  expect_in(
      package.refusal(model(
          object("1", kMesh + std::string(R"(<components><component objectid="1"/></components>)")),
          item)),
      "one of them");
  EXPECT_EQ(package.read(model(mesh, "")).warnings.size(), 1u);
  expect_in(error_of([&] { (void)read_mesh(package.write({{"a.txt", "x"}})); }), "no 3MF");
  const TempFolder folder;
  const std::string whole = contents(package.write({{"3D/3dmodel.model", model(mesh, item)}}));
  expect_in(error_of([&] { (void)read_mesh(folder.write("m.3mf", whole.substr(0, 300))); }),
            "is no ZIP archive");
  std::string damaged = whole;
  damaged[whole.size() / 3] = static_cast<char>(damaged[whole.size() / 3] ^ 64);
  expect_in(error_of([&] { (void)read_mesh(folder.write("n.3mf", damaged)); }), "n.3mf: ");
}

// At once, for whatever is doubled: what it comes to is counted before it is placed.
TEST(IoThreemf, components_that_double_are_refused) {
  Package package;
  const auto doubled = [](int times) {
    std::string objects = object("0", kMesh);
    for (int i = 1; i <= times; ++i) {
      const std::string one = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
      objects += object(std::to_string(i), "<components>" + one + one + "</components>");
    }
    return model(objects, "<item objectid=\"" + std::to_string(times) + "\"/>");
  };
  EXPECT_EQ(package.read(doubled(10)).part_names.size(), 1024u);
  for (const int times : {20, 24, 60, 99}) {
    expect_in(
        package.refusal(doubled(times)),
        "object '" + std::to_string(times) + "': the build places more than 1,048,576 objects");
  }
  expect_in(package.refusal(doubled(101)), "lie more than 100 deep");
}

TEST(IoThreemf, a_small_archive_does_not_become_all_the_memory) {
  Package package;
  const std::string item = R"(<item objectid="1"/>)";
  const std::string root =
      model(object("1", kMesh), item) + std::string(std::size_t{65} << 20, ' ');
  expect_in(package.refusal(root), "'3D/Main.model' unpacks to more than");
  // Two parts that are too large together.
  const std::string half(std::size_t{40} << 20, ' ');
  const std::string both = model(
      object("1", R"(<components><component objectid="7" p:path="/3D/a.model"/></components>)"),
      item);
  expect_in(package.refusal(both + half, {{"3D/a.model", model(object("7", kMesh), "") + half}}),
            "'3D/a.model' unpacks to more than");
}

}  // namespace
}  // namespace pierce::io

// SPDX-License-Identifier: Apache-2.0
#include "io/hits.h"

#include <array>
#include <type_traits>

#include "io/record_file.h"

namespace pierce::io {
namespace {

template <class Real>
constexpr std::string_view kReal = std::is_same_v<Real, float> ? "<f4" : "<f8";

template <class Real>
constexpr std::array<RecordColumn, 8> kAllColumns = {{{"ray", "<u8"},
                                                      {"t", kReal<Real>},
                                                      {"u", kReal<Real>},
                                                      {"v", kReal<Real>},
                                                      {"w", kReal<Real>},
                                                      {"geometry", "<u4"},
                                                      {"triangle", "<u4"},
                                                      {"facing", "|u1"}}};

constexpr std::array<RecordColumn, 1> kAnyColumns = {{{"hit", "|b1"}}};
constexpr std::array<RecordColumn, 3> kCrossingsColumns = {
    {{"count", "<u4"}, {"signed_count", "<i4"}, {"origin_on_surface", "|b1"}}};
constexpr std::array<RecordColumn, 1> kCountColumns = {{{"count", "<u4"}}};
constexpr std::array<RecordColumn, 1> kLocationColumns = {{{"location", "|i1"}}};

template <class Real>
constexpr std::array<RecordColumn, 10> kNearestColumns = {{{"x", kReal<Real>},
                                                           {"y", kReal<Real>},
                                                           {"z", kReal<Real>},
                                                           {"distance", kReal<Real>},
                                                           {"u", kReal<Real>},
                                                           {"v", kReal<Real>},
                                                           {"w", kReal<Real>},
                                                           {"geometry", "<u4"},
                                                           {"triangle", "<u4"},
                                                           {"feature", "|u1"}}};

std::unique_ptr<RecordFile> open(const RecordTarget& target,
                                 std::span<const RecordColumn> columns) {
  return std::make_unique<RecordFile>(target, columns);
}

}  // namespace

RecordWriter::RecordWriter(std::unique_ptr<RecordFile> file) : file_(std::move(file)) {}
RecordWriter::RecordWriter(RecordWriter&&) noexcept = default;
RecordWriter& RecordWriter::operator=(RecordWriter&&) noexcept = default;
RecordWriter::~RecordWriter() = default;

void RecordWriter::finish() { file_->finish(); }

template <class Real>
ClosestWriter<Real>::ClosestWriter(const RecordTarget& target)
    : RecordWriter(open(target, std::span(kAllColumns<Real>).subspan(1))) {}

template <class Real>
void ClosestWriter<Real>::append(std::span<const Hit<Real>> hits) {
  for (const Hit<Real>& h : hits) {
    file_->row(h.t, h.u, h.v, h.w, h.geometry, h.triangle, static_cast<std::uint8_t>(h.facing));
  }
}

template <class Real>
AllWriter<Real>::AllWriter(const RecordTarget& target, std::uint64_t first_ray)
    : RecordWriter(open(target, kAllColumns<Real>)), rays_(first_ray) {}

template <class Real>
void AllWriter<Real>::append(const HitLists<Real>& lists) {
  for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i, ++rays_) {
    for (const Hit<Real>& h : lists.of(i)) {
      file_->row(rays_, h.t, h.u, h.v, h.w, h.geometry, h.triangle,
                 static_cast<std::uint8_t>(h.facing));
    }
  }
}

AnyWriter::AnyWriter(const RecordTarget& target) : RecordWriter(open(target, kAnyColumns)) {}

void AnyWriter::append(std::span<const std::uint8_t> hits) {
  for (const std::uint8_t hit : hits) file_->row(hit != 0);
}

CountWriter::CountWriter(const RecordTarget& target) : RecordWriter(open(target, kCountColumns)) {}

void CountWriter::append(std::span<const std::uint32_t> counts) {
  for (const std::uint32_t count : counts) file_->row(count);
}

CrossingsWriter::CrossingsWriter(const RecordTarget& target)
    : RecordWriter(open(target, kCrossingsColumns)) {}

void CrossingsWriter::append(std::span<const Crossings> crossings) {
  for (const Crossings& c : crossings) file_->row(c.count, c.signed_count, c.origin_on_surface);
}

LocationWriter::LocationWriter(const RecordTarget& target)
    : RecordWriter(open(target, kLocationColumns)) {}

void LocationWriter::append(std::span<const Location> locations) {
  for (const Location location : locations) file_->row(static_cast<std::int8_t>(location));
}

template <class Real>
NearestWriter<Real>::NearestWriter(const RecordTarget& target)
    : RecordWriter(open(target, kNearestColumns<Real>)) {}

template <class Real>
void NearestWriter<Real>::append(std::span<const NearestPoint<Real>> nearest) {
  for (const NearestPoint<Real>& n : nearest) {
    file_->row(n.point.x, n.point.y, n.point.z, n.distance, n.u, n.v, n.w, n.geometry, n.triangle,
               static_cast<std::uint8_t>(n.feature));
  }
}

template class ClosestWriter<float>;
template class ClosestWriter<double>;
template class AllWriter<float>;
template class AllWriter<double>;
template class NearestWriter<float>;
template class NearestWriter<double>;

}  // namespace pierce::io

// SPDX-License-Identifier: Apache-2.0
//
// Answers out: one writer for each kind of query, to .npy (little-endian records, laid out as the
// structs of pierce are: a Hit<float> has 28 bytes, a Hit<double> 48), .npz (each column an array
// of its own) or .csv (a line of titles and the same columns, numbers in the shortest form that
// reads back exactly).
//
// Every writer takes the answers piece by piece, in the order of the rays, and writes under a
// temporary name in the same folder; `finish` gives the file its name. A writer that is destroyed
// unfinished (an exception, a stop) removes what it wrote. A full disk is Error (BadFile).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "io/record_target.h"
#include "pierce/nearest.h"
#include "pierce/types.h"

namespace pierce::io {

/// A file of records under construction; what all writers share.
class RecordFile;

class RecordWriter {
 public:
  RecordWriter(RecordWriter&&) noexcept;
  RecordWriter& operator=(RecordWriter&&) noexcept;
  ~RecordWriter();

  /// Completes the file and gives it its name. Nothing may be appended afterwards.
  void finish();

 protected:
  explicit RecordWriter(std::unique_ptr<RecordFile> file);
  std::unique_ptr<RecordFile> file_;
};

/// closest: `t, u, v, w, geometry, triangle, facing`, one record a ray.
template <class Real>
class ClosestWriter : public RecordWriter {
 public:
  explicit ClosestWriter(const RecordTarget& target);
  void append(std::span<const Hit<Real>> hits);
};

/// all: `ray` (eight bytes; the first is `first_ray`) and the fields of closest, one record a hit,
/// grouped by ray.
template <class Real>
class AllWriter : public RecordWriter {
 public:
  explicit AllWriter(const RecordTarget& target, std::uint64_t first_ray = 0);
  /// The lists of the next rays; rays are counted over all calls.
  void append(const HitLists<Real>& lists);

 private:
  std::uint64_t rays_ = 0;
};

/// any: one bool a ray.
class AnyWriter : public RecordWriter {
 public:
  explicit AnyWriter(const RecordTarget& target);
  void append(std::span<const std::uint8_t> hits);
};

/// count: one u4 a ray.
class CountWriter : public RecordWriter {
 public:
  explicit CountWriter(const RecordTarget& target);
  void append(std::span<const std::uint32_t> counts);
};

/// crossings: `count, signed_count, origin_on_surface`, one record a ray.
class CrossingsWriter : public RecordWriter {
 public:
  explicit CrossingsWriter(const RecordTarget& target);
  void append(std::span<const Crossings> crossings);
};

/// locate: one int8 a point, +1 inside, 0 on the surface, -1 outside.
class LocationWriter : public RecordWriter {
 public:
  explicit LocationWriter(const RecordTarget& target);
  void append(std::span<const Location> locations);
};

/// nearest: `x, y, z, distance, u, v, w, geometry, triangle, feature`, one record a point.
template <class Real>
class NearestWriter : public RecordWriter {
 public:
  explicit NearestWriter(const RecordTarget& target);
  void append(std::span<const NearestPoint<Real>> nearest);
};

extern template class ClosestWriter<float>;
extern template class ClosestWriter<double>;
extern template class AllWriter<float>;
extern template class AllWriter<double>;
extern template class NearestWriter<float>;
extern template class NearestWriter<double>;

}  // namespace pierce::io

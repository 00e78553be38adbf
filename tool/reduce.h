// SPDX-License-Identifier: Apache-2.0
//
// The values of --reduce: what is kept of the answers, so that answers need not be. Each has the
// form of the queries in cast_queries.h, and writes a .npy file of its own:
//
//   bits       a bit a ray, eight a byte from the highest on, as numpy.packbits has them: hit or
//   not depth      t of the first hit, infinite for none, in the shape of the picture histogram how
//   many first hits have their t in each of so many equal parts of a range triangles  how many
//   first hits each triangle has, all geometries counted through parts      how many first hits
//   each geometry has
//
// The last three are sums: those of chunks add up to those of the whole.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "cast_queries.h"
#include "io/npy.h"
#include "io/output_file.h"
#include "pierce/scene.h"

namespace pierce::tool {

enum class Reduction : std::uint8_t { None, Bits, Depth, Histogram, Triangles, Parts };

[[nodiscard]] inline bool is_sum(Reduction reduction) { return reduction >= Reduction::Histogram; }

struct ReduceOptions {
  Reduction reduction = Reduction::None;
  std::uint64_t bins = 100;
  double low = 0, high = 0;  ///< of a histogram: t from `low` on, below `high`
};

/// An array on its way to a .npy file.
class ArrayFile {
 public:
  ArrayFile(const std::filesystem::path& path, std::string_view descr,
            std::span<const std::uint64_t> shape)
      : file_(std::make_unique<io::OutputFile>(path)) {
    file_->write(io::make_npy_header(descr, shape));
  }
  template <class T>
  void append(std::span<const T> values) {
    file_->write({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  }
  void finish() { file_->commit(); }

 private:
  std::unique_ptr<io::OutputFile> file_;
};

template <class Real>
class BitsReduction : public WritesLater {
 public:
  BitsReduction(const std::filesystem::path& path, std::uint64_t rays)
      : file_(path, "'|u1'", std::vector<std::uint64_t>{(rays + 7) / 8}) {}

  /// All but the last piece have a multiple of eight rays.
  void make_room(std::size_t size) { hits_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.any_hits(rays, std::span(hits_).subspan(at, rays.size()), options);
  }
  std::uint64_t finish_piece() {
    hits_.resize((hits_.size() + 7) / 8 * 8);  // by zeros
    bits_.resize(hits_.size() / 8);
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      // A multiplication brings bit 8 k to 63 - k, for each k, or adds eight bytes up in the
      // highest; nothing else reaches that.
      const std::uint64_t eight = eight_bytes(&hits_[8 * i]);
      bits_[i] = static_cast<std::uint8_t>((eight * 0x8040201008040201U) >> 56);
      found += (eight * 0x0101010101010101U) >> 56;
    }
    return found;
  }
  void write() { file_.append(std::span<const std::uint8_t>(bits_)); }
  void finish() { file_.finish(); }

 private:
  static std::uint64_t eight_bytes(const std::uint8_t* bytes) {
    std::uint64_t all = 0;
    for (int k = 0; k < 8; ++k) all |= std::uint64_t{bytes[k]} << (8 * k);
    return all;
  }

  ArrayFile file_;
  std::vector<std::uint8_t> hits_, bits_;
};

template <class Real>
class DepthReduction : public WritesLater {
 public:
  DepthReduction(const std::filesystem::path& path, std::span<const std::uint64_t> shape)
      : file_(path, std::is_same_v<Real, float> ? "'<f4'" : "'<f8'", shape) {}

  void make_room(std::size_t size) { t_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.closest_hits(RayArrays<Real>::of(rays),
                       HitArrays<Real>{.t = rows(std::span(t_).subspan(at, rays.size()))}, options);
  }
  std::uint64_t finish_piece() {
    return t_.size() -
           static_cast<std::uint64_t>(std::count(t_.begin(), t_.end(), kInfinity<Real>));
  }
  void write() { file_.append(std::span<const Real>(t_)); }
  void finish() { file_.finish(); }

 private:
  ArrayFile file_;
  std::vector<Real> t_;
};

/// Histogram, Triangles, Parts.
template <class Real>
class CountsReduction : public WritesLater {
 public:
  CountsReduction(std::filesystem::path path, const ReduceOptions& options,
                  const Scene<Real>& scene)
      : path_(std::move(path)), options_(options) {
    std::uint64_t triangles = 0;
    for (const MeshView<Real>& mesh : scene.meshes()) {
      first_.push_back(triangles);
      triangles += mesh.triangles.size();
    }
    counts_.resize(options.reduction == Reduction::Histogram   ? options.bins
                   : options.reduction == Reduction::Triangles ? triangles
                                                               : first_.size());
  }

  void make_room(std::size_t size) { hits_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.closest_hits(rays, std::span(hits_).subspan(at, rays.size()), options);
  }
  std::uint64_t finish_piece() {
    std::uint64_t found = 0;
    for (const Hit<Real>& hit : hits_) {
      if (hit.triangle == kNone) continue;
      ++found;
      if (options_.reduction == Reduction::Triangles) {
        ++counts_[first_[hit.geometry] + hit.triangle];
      } else if (options_.reduction == Reduction::Parts) {
        ++counts_[hit.geometry];
      } else {
        count(static_cast<double>(hit.t));
      }
    }
    return found;
  }
  void write() {}
  void finish() {
    ArrayFile file(path_, "'<u8'", std::vector<std::uint64_t>{counts_.size()});
    file.append(std::span<const std::uint64_t>(counts_));
    file.finish();
  }

 private:
  void count(double t) {
    if (!(t >= options_.low && t < options_.high)) return;
    const double part = (t - options_.low) / (options_.high - options_.low);
    const auto bin = static_cast<std::uint64_t>(part * static_cast<double>(options_.bins));
    ++counts_[std::min(bin, options_.bins - 1)];
  }

  std::filesystem::path path_;
  ReduceOptions options_;
  std::vector<std::uint64_t> first_, counts_;
  std::vector<Hit<Real>> hits_;
};

}  // namespace pierce::tool

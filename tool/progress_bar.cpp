// SPDX-License-Identifier: Apache-2.0
#include "progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <utility>

#include "support/progress.h"

namespace pierce::tool {
namespace {

constexpr auto kFirst = std::chrono::milliseconds(400);
constexpr auto kEvery = std::chrono::milliseconds(100);
constexpr std::size_t kWidth = 40;

void put(const std::string& text) {
  // A terminal that has gone away is no reason to stop.
  (void)!::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)),
      terminal_(isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()),
      next_(begin_ + kFirst) {}

ProgressBar::~ProgressBar() {
  if (shown_) put("\r\x1b[K");
}

void ProgressBar::show(double fraction) {
  if (!terminal_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + kEvery;
  shown_ = true;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto full = static_cast<std::size_t>(fraction * kWidth);
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double left = fraction > 0.01 ? elapsed * (1 - fraction) / fraction : -1;
  const std::string note = note_.empty() ? "" : "  " + note_;
  put(fmt::format("\r{} [{}{}] {:3.0f} %{}{}\x1b[K", label_, std::string(full, '#'),
                  std::string(kWidth - full, '.'), 100 * fraction,
                  left < 0 ? "" : fmt::format("  {:.0f} s left", left), note));
}

Progress ProgressBar::callback(double from, double to) {
  if (!terminal_) return {};
  return part_of([this](double fraction) { show(fraction); }, from, to);
}

}  // namespace pierce::tool

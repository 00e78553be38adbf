// SPDX-License-Identifier: Apache-2.0
//
// A thread of its own waits for the signals: what ends the program removes files, which takes locks
// that a signal handler must not take.
#include "interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "io/output_file.h"
#include "pierce/error.h"

namespace pierce::tool::interrupt {
namespace {

std::atomic<bool> stop_wanted{false};
std::atomic<int> graceful_work{0};
std::atomic<int> received{0};

bool was_ignored(int signal) {
  struct sigaction action = {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void watch(sigset_t signals) {
  for (;;) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) continue;
    const bool first = received.exchange(signal) == 0;
    if (!first || graceful_work.load() == 0) end_at_once(128 + signal);
    stop_wanted = true;
  }
}

}  // namespace

void install() {
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (!was_ignored(signal)) sigaddset(&signals, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(watch, signals).detach();
}

const std::atomic<bool>* stop() { return &stop_wanted; }

int exit_status() { return 128 + received.load(); }

void end_at_once(int status) {
  io::abandon_output_files();
  _exit(status);
}

void check() {
  if (stop_wanted) throw Error(ErrorCode::Stopped, "stopped");
}

Graceful::Graceful() { ++graceful_work; }
Graceful::~Graceful() { --graceful_work; }

}  // namespace pierce::tool::interrupt

#include "sim/host/interruption.hpp"

#include <signal.h>

namespace tumblesight::sim {
namespace {

volatile sig_atomic_t arrived = 0;

void note(int signal) {
  arrived = signal;
}

void note_once(int signal) {
  struct sigaction before {};
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(signal, &action, nullptr);
}

void restore(int signal) {
  struct sigaction now {};
  if (sigaction(signal, nullptr, &now) != 0 || now.sa_handler != note) return;
  now.sa_handler = SIG_DFL;
  sigaction(signal, &now, nullptr);
}

}  // namespace

Interruption::Interruption() {
  arrived = 0;
  note_once(SIGINT);
  note_once(SIGTERM);
  note_once(SIGHUP);
}

Interruption::~Interruption() {
  restore(SIGINT);
  restore(SIGTERM);
  restore(SIGHUP);
}

int Interruption::signal() {
  return arrived;
}

}  // namespace tumblesight::sim

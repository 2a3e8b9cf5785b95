#include "interrupt.hpp"

#include <csignal>

namespace carom::cli {

namespace {

volatile std::sig_atomic_t noted_signal = 0;

void note(int number) { noted_signal = number; }

} // namespace

void note_interrupts() {
    struct sigaction action{};
    action.sa_handler = note;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

int interrupted_by() noexcept { return noted_signal; }

} // namespace carom::cli

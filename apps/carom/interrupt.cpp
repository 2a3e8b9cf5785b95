#include "interrupt.hpp"

#include <csignal>

namespace carom::cli {

namespace {

volatile std::sig_atomic_t noted_signal = 0;

void handle(void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void note(int number) {
    noted_signal = number;
    handle(SIG_DFL);
}

} // namespace

void note_interrupts() { handle(note); }

int interrupted_by() noexcept { return noted_signal; }

} // namespace carom::cli

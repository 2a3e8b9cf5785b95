#include <carom/base.hpp>
#include <carom/executor.hpp>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#ifdef CAROM_WITH_TBB
#    include <oneapi/tbb/info.h>
#    include <oneapi/tbb/parallel_for.h>
#    include <oneapi/tbb/task_arena.h>
#endif

namespace carom {

namespace {

unsigned threads_or_cores(unsigned threads) {
    if (threads > most_threads) {
        throw Error(ErrorCode::out_of_range, "threads",
                    "must be at most " + std::to_string(most_threads) + ", got " + std::to_string(threads));
    }
    return threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

class SerialExecutor : public Executor {
public:
    [[nodiscard]] unsigned threads() const noexcept override { return 1; }
    void run(std::size_t parts, Task task, void* context) override {
        for (std::size_t part = 0; part < parts; ++part) task(context, part);
    }
};

/// A loop that several threads take parts of.
class Loop {
public:
    Loop(std::size_t parts, Executor::Task task, void* context) : parts_(parts), task_(task), context_(context) {}

    /// Takes parts until none is left. The first thing that is thrown is kept.
    void work() noexcept {
        for (std::size_t part = next_++; part < parts_; part = next_++) {
            try {
                task_(context_, part);
            } catch (...) {
                const std::scoped_lock lock(mutex_);
                if (!thrown_) thrown_ = std::current_exception();
            }
        }
    }
    void rethrow() const {
        if (thrown_) std::rethrow_exception(thrown_);
    }

private:
    std::size_t parts_;
    Executor::Task task_;
    void* context_;
    std::atomic<std::size_t> next_{0};
    std::mutex mutex_;
    std::exception_ptr thrown_;
};

/// Threads that sleep between loops. One loop runs at a time; a second caller waits.
class ThreadExecutor : public Executor {
public:
    explicit ThreadExecutor(unsigned threads) {
        try {
            for (unsigned k = 1; k < threads; ++k) helpers_.emplace_back([this] { help(); });
        } catch (const std::system_error& error) {
            const std::size_t started = helpers_.size() + 1;
            dismiss();
            throw Error(ErrorCode::not_available, "threads",
                        "the system gives no more than " + std::to_string(started) + " of " + std::to_string(threads) +
                            ": " + error.what());
        } catch (...) {
            dismiss();
            throw;
        }
    }
    ThreadExecutor(const ThreadExecutor&) = delete;
    ThreadExecutor& operator=(const ThreadExecutor&) = delete;
    ~ThreadExecutor() override { dismiss(); }

    [[nodiscard]] unsigned threads() const noexcept override { return static_cast<unsigned>(helpers_.size()) + 1; }

    void run(std::size_t parts, Task task, void* context) override {
        const std::scoped_lock one_at_a_time(callers_);
        Loop loop(parts, task, context);
        {
            const std::scoped_lock lock(mutex_);
            loop_ = &loop;
            ++loops_;
            busy_ = helpers_.size();
        }
        start_.notify_all();
        loop.work();
        std::unique_lock lock(mutex_);
        end_.wait(lock, [this] { return busy_ == 0; });
        loop_ = nullptr;
        loop.rethrow();
    }

private:
    void help() {
        std::uint64_t done = 0;
        std::unique_lock lock(mutex_);
        while (true) {
            start_.wait(lock, [&] { return ends_ || loops_ != done; });
            if (ends_) return;
            done = loops_;
            Loop* const loop = loop_;
            lock.unlock();
            loop->work();
            lock.lock();
            if (--busy_ == 0) end_.notify_one();
        }
    }

    void dismiss() {
        {
            const std::scoped_lock lock(mutex_);
            ends_ = true;
        }
        start_.notify_all();
        for (std::thread& helper : helpers_) helper.join();
    }

    std::vector<std::thread> helpers_;
    std::mutex callers_;
    std::mutex mutex_; ///< of what follows
    std::condition_variable start_;
    std::condition_variable end_;
    Loop* loop_ = nullptr;
    std::uint64_t loops_ = 0; ///< that were started
    std::size_t busy_ = 0;    ///< helpers that have not ended the present loop
    bool ends_ = false;
};

#ifdef CAROM_WITH_TBB
class TbbExecutor : public Executor {
public:
    /// oneTBB has as many threads as there are cores, and says so on the standard error output when asked for more.
    explicit TbbExecutor(unsigned threads)
        : threads_(threads), arena_(std::min(static_cast<int>(threads), tbb::info::default_concurrency())) {}

    [[nodiscard]] unsigned threads() const noexcept override { return threads_; }
    void run(std::size_t parts, Task task, void* context) override {
        arena_.execute([&] {
            tbb::parallel_for(
                std::size_t{0}, parts, [&](std::size_t part) { task(context, part); }, tbb::simple_partitioner{});
        });
    }

private:
    unsigned threads_;
    tbb::task_arena arena_;
};
#endif

} // namespace

std::shared_ptr<Executor> make_serial_executor() { return std::make_shared<SerialExecutor>(); }

std::shared_ptr<Executor> make_thread_executor(unsigned threads) {
    return std::make_shared<ThreadExecutor>(threads_or_cores(threads));
}

std::shared_ptr<Executor> make_default_executor(unsigned threads) {
    const unsigned count = threads_or_cores(threads);
    if (count == 1) return make_serial_executor();
#ifdef CAROM_WITH_TBB
    return std::make_shared<TbbExecutor>(count);
#else
    return make_thread_executor(count);
#endif
}

} // namespace carom

#pragma once

#include <barrier>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <thread>
#include <vector>

#include "interflect/ranks.h"

namespace interflect::testing_support {

/// Ranks that are threads of this process.
class ThreadRanks {
  public:
    explicit ThreadRanks(int count) : sent_(static_cast<std::size_t>(count)), barrier_(count) {}

    /// Calls body(ranks) in every thread and waits for the end. Rethrows the first exception.
    template <class Body>
    void run(const Body& body) {
        std::vector<std::exception_ptr> errors(sent_.size());
        std::vector<std::thread> threads;
        for (std::size_t r = 0; r < sent_.size(); ++r)
            threads.emplace_back([&, r] {
                One one(*this, r);
                try {
                    body(one);
                } catch (...) {
                    errors[r] = std::current_exception();
                    barrier_.arrive_and_drop();
                }
            });
        for (std::thread& thread : threads) thread.join();
        for (const std::exception_ptr& error : errors)
            if (error) std::rethrow_exception(error);
    }

  private:
    class One : public Ranks {
      public:
        One(ThreadRanks& all, std::size_t rank) : all_(all), rank_(rank) {}
        int rank() const override { return static_cast<int>(rank_); }
        int count() const override { return static_cast<int>(all_.sent_.size()); }
        std::vector<Bytes> exchange(const std::vector<Bytes>& parts) override {
            all_.sent_[rank_] = parts;
            all_.barrier_.arrive_and_wait();
            std::vector<Bytes> received;
            for (const std::vector<Bytes>& of_rank : all_.sent_) received.push_back(of_rank.at(rank_));
            all_.barrier_.arrive_and_wait();
            return received;
        }
        std::vector<Bytes> gather(std::span<const std::byte> bytes) override {
            return exchange(std::vector<Bytes>(all_.sent_.size(), Bytes(bytes.begin(), bytes.end())));
        }
        void broadcast(std::span<std::byte> bytes) override {
            const Bytes first = gather(bytes).front();
            std::copy(first.begin(), first.end(), bytes.begin());
        }
        void abort(int exit_code) override { std::exit(exit_code); }
        Traffic traffic() const override { return {}; }

      private:
        ThreadRanks& all_;
        std::size_t rank_;
    };

    std::vector<std::vector<Ranks::Bytes>> sent_;  // [from][to]
    std::barrier<> barrier_;
};

}  // namespace interflect::testing_support

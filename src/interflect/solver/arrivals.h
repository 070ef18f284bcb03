#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "interflect/base/stable_array.h"

namespace interflect {

/// What the rays of a step bring to elements, as integers in units of the step's, so that the order of arrival does not
/// matter: three channels of power, then importance. Every thread collects arrivals in a Sorter of its own, which hands
/// them on by the hundred and by region of the forest: no addition is atomic, and those of one lot are close together.
class Arrivals {
  public:
    using Load = std::array<std::int64_t, 4>;

    /// @param loads     What one ray of each source carries.
    /// @param elements  Of the forest so far. @param capacity  Most elements ever.
    /// @throws std::length_error for more than 2^30 sources.
    Arrivals(std::vector<Load> loads, std::size_t elements, std::size_t capacity);

    Load& operator[](std::size_t element) { return sums_[element]; }
    const Load& load(std::size_t source) const { return loads_[source]; }

    class Sorter {
      public:
        explicit Sorter(Arrivals& arrivals) : arrivals_(&arrivals) {}

        void add(std::uint32_t element, std::uint32_t source, bool power, bool importance) {
            const std::size_t region = element >> arrivals_->region_shift_ & (regions - 1);
            Lot& lot = lots_[region];
            lot.arrivals[lot.count++] = {element, source & (most_sources - 1), power, importance};
            if (lot.count == lot.arrivals.size()) hand_on(region);
        }
        /// To be called when all has been added.
        void hand_on_all() {
            for (std::size_t region = 0; region < regions; ++region) hand_on(region);
        }

      private:
        struct Arrival {
            std::uint32_t element;
            std::uint32_t source : 30;
            std::uint32_t power : 1, importance : 1;  // what of the load arrives here
        };
        struct Lot {
            std::size_t count = 0;
            std::array<Arrival, 127> arrivals;
        };
        void hand_on(std::size_t region);

        Arrivals* arrivals_;
        std::vector<Lot> lots_ = std::vector<Lot>(regions);
    };

  private:
    static constexpr std::size_t regions = 64;
    static constexpr std::uint32_t most_sources = 1u << 30;  // an Arrival has as many bits for them

    std::vector<Load> loads_;
    StableArray<Load> sums_;
    int region_shift_ = 0;
    std::array<std::mutex, regions> at_work_;
};

}  // namespace interflect

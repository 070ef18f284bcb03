#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interflect/formats/mgf/context/contexts.h"

namespace interflect::detail {

/// Errors in colours and materials, reported only if a face uses them.
class MgfFaults {
  public:
    /// Stores an error, one per line of a file. Returns its index.
    std::uint32_t add(const Location& where, const std::string& message);

    /// @throws InputError unless `fault` is none.
    void refuse(std::uint32_t fault) const;
    /// Refuses the faults of a material and of its rd and ed colours.
    void refuse_faults_of(const MgfMaterial& material) const;
    void refuse_first() const { refuse(faults_.empty() ? none : 0); }

  private:
    struct LocatedFault {
        Location where;
        std::string message;
    };
    std::vector<LocatedFault> faults_;
    std::map<std::pair<const std::filesystem::path*, std::int64_t>, std::uint32_t> index_;
};

}  // namespace interflect::detail

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interflect/formats/mgf_contexts.h"

namespace interflect::inline detail {

/// Errors in colours and materials. They count only if a face uses the colour or material, because real files define
/// more than they use.
class MgfFaults {
  public:
    /// Stores an error, once per line even if the line is read repeatedly. @return  its index, for a context to keep.
    std::uint32_t add(const Location& where, const std::string& message);

    /// @throws InputError  with the file and line of the error, unless `fault` is none.
    void refuse(std::uint32_t fault) const;
    /// Refuses errors of the material and of the colours of its rd and ed.
    void refuse_faults_of(const MgfMaterial& material) const;
    /// Refuses the first error, if any.
    void refuse_first() const { refuse(faults_.empty() ? none : 0); }

  private:
    struct LocatedFault {
        Location where;
        std::string message;
    };
    std::vector<LocatedFault> faults_;
    std::map<std::pair<const std::filesystem::path*, std::int64_t>, std::uint32_t> index_;
};

}  // namespace interflect::inline detail

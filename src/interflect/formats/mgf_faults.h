#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interflect/formats/mgf_contexts.h"

namespace interflect::inline detail {

/// The faults in colours and materials, which count only when a face uses them: real files define more than they use,
/// and what nobody sees should not make them unreadable.
class MgfFaults {
  public:
    /// Remembers a fault, once for each line however often that is read. @return its index, for a context to keep.
    std::uint32_t add(const Location& where, const std::string& message);

    /// @throws InputError  with the file and line of the fault, unless `fault` is none.
    void refuse(std::uint32_t fault) const;
    /// The same for what the material holds, and for those of its colours that count.
    void refuse_faults_of(const MgfMaterial& material) const;
    /// The same for the first fault, where there is one.
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

#include "interflect/formats/mgf/context/faults.h"

namespace interflect::detail {

std::uint32_t MgfFaults::add(const Location& where, const std::string& message) {
    const auto [entry, is_new] =
        index_.try_emplace({where.file, where.line}, static_cast<std::uint32_t>(faults_.size()));
    if (is_new) faults_.push_back({where, message});
    return entry->second;
}

void MgfFaults::refuse(std::uint32_t fault) const {
    if (fault == none) return;
    const auto& [where, message] = faults_[fault];
    throw where.error(message);
}

void MgfFaults::refuse_faults_of(const MgfMaterial& material) const {
    refuse(material.fault);
    if (material.rd > 0) refuse(material.rd_colour.fault);
    if (material.ed > 0) refuse(material.ed_colour.fault);
}

}  // namespace interflect::detail

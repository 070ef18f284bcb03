#include "interflect/formats/mgf/reader.h"
#include "interflect/formats/reading/read_fault.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace interflect::detail {

using Imath::M44d;

void MgfReader::transform(MgfWords words) {
    if (!words.empty()) {
        open_transform(words, file_->lines.position());
        return;
    }
    if (transforms_.size() <= file_->outer_transforms)
        throw MgfFault("this closes a transform, but none was opened in this file");
    close_transform();
}

void MgfReader::open_transform(MgfWords words, const LineReader::Position& body) {
    if (transforms_.size() >= static_cast<std::size_t>(options_.max_nesting))
        throw MgfFault(fmt::format("transforms are nested more than {} deep", options_.max_nesting));
    OpenMgfTransform transform{TransformSequence(words),
                               M44d(),
                               here(),
                               {},
                               body,
                               transforms_.empty() ? 1 : transforms_.back().copies_together,
                               scene_.patch_count()};
    for (const int size : transform.sequence.array_sizes()) transform.copies_together *= size;
    if (transform.copies_together > static_cast<double>(options_.max_patches))
        throw ReadFault(fmt::format("an array of {:.0f} copies is beyond the limit of {} patches (max_patches)",
                                    transform.copies_together, options_.max_patches),
                        "max_patches");
    transform.copy.assign(transform.sequence.array_sizes().size(), 0);
    transforms_.push_back(std::move(transform));
    place_copy(transforms_.back());
}

/// Closes a transform, or begins its next array copy. Returns whether another copy follows.
bool MgfReader::close_transform() {
    OpenMgfTransform& transform = transforms_.back();
    if (transform.sequence.is_array()) {
        objects_.close_copy();
        if (next_copy(transform)) {
            place_copy(transform);
            file_->lines.seek(transform.body);
            return true;
        }
        repeating_arrays_ -= transform.repeating;
    }
    transforms_.pop_back();
    return false;
}

void MgfReader::place_copy(OpenMgfTransform& transform) {
    const M44d& outer = transforms_.size() > 1 ? transforms_[transforms_.size() - 2].total : file_to_world_;
    transform.total = transform.sequence.matrix(transform.copy) * outer;
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(transform.total[i / 4][i % 4])) throw MgfFault("the transform is not finite");
    if (transform.sequence.is_array()) objects_.open(fmt::format("a{}", fmt::join(transform.copy, ".")), true, here());
}

bool MgfReader::next_copy(OpenMgfTransform& transform) {
    if (!transform.repeating) {
        double copies = 1;
        for (const int size : transform.sequence.array_sizes()) copies *= size;
        scene_.require_room(static_cast<double>(scene_.patch_count() - transform.first_patch) * (copies - 1));
        transform.repeating = true;
        ++repeating_arrays_;
    }
    count_repeated(RepeatedWork::words_per_copy);
    return next_index(transform.copy, transform.sequence.array_sizes());
}

}  // namespace interflect::detail

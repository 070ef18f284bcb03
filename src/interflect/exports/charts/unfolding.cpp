#include "interflect/exports/charts/unfolding.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "interflect/exports/charts/moments.h"

namespace interflect::detail {

namespace {

/// Maximum number of patches in a layout. It is limited because each new piece is compared with all patches of its
/// layout.
constexpr std::size_t max_patches_unfolded = 4096;

/// Maximum relative change of edge lengths.
constexpr double max_stretch = 0.1;
/// Maximum relative change of the parallelogram of the two edges at a corner.
constexpr double max_shear = 0.2;

/// Pieces that exceed this multiple of the limits close a loop, as around a cylinder.
constexpr double closing = 3;

/// Layouts with less fill (Moments::fill()) waste their rectangle. With 0.5 or 0.7, the layouts of office, torus and
/// sphere are nearly the same; 0.8 also cuts flat walls (docs/files/export.md).
constexpr double min_fill = 0.5;

/// Relative tolerance for rounding errors.
constexpr double flat_rounding = 1e-4;

/// Rotation about `from`, then translation of `from` to `to`.
struct RigidMotion {
    Imath::V2d from, to, cos_sin;

    Imath::V2d operator()(const Imath::V2d& x) const {
        const Imath::V2d d = x - from;
        return to + Imath::V2d(cos_sin.x * d.x - cos_sin.y * d.y, cos_sin.y * d.x + cos_sin.x * d.y);
    }
};

using PointPair = std::pair<Imath::V2d, Imath::V2d>;

/// Returns the motion with the smallest sum of squared distances (Kabsch 1976); nullopt if all points coincide.
std::optional<RigidMotion> best_motion(std::span<const PointPair> pairs) {
    RigidMotion motion{{0, 0}, {0, 0}, {0, 0}};
    for (const auto& [from, to] : pairs) {
        motion.from += from / static_cast<double>(pairs.size());
        motion.to += to / static_cast<double>(pairs.size());
    }
    for (const auto& [from, to] : pairs) {
        const Imath::V2d a = from - motion.from, b = to - motion.to;
        motion.cos_sin += {a.dot(b), a.cross(b)};
    }
    if (!(motion.cos_sin.length() > 0)) return std::nullopt;
    motion.cos_sin.normalize();
    return motion;
}

/// Returns whether edge lengths and parallelograms at corners differ by at most `stretch` and `shear`.
bool is_alike(const FlatPatch& a, const FlatPatch& b, double stretch, double shear) {
    const std::size_t count = a.outline().size();
    const auto is_within = [](double x, double y, double share) { return std::abs(x - y) <= share * std::abs(x); };
    for (std::size_t c = 0; c < count; ++c) {
        const std::size_t next = (c + 1) % count, last = (c + count - 1) % count;
        const auto edge = [&](const FlatPatch& flat, std::size_t to) { return flat.corners[to] - flat.corners[c]; };
        if (!is_within(edge(a, next).length(), edge(b, next).length(), stretch)) return false;
        if (!is_within(edge(a, next).cross(edge(a, last)), edge(b, next).cross(edge(b, last)), shear)) return false;
    }
    return true;
}

class Unfolding {
  public:
    Unfolding(const Scene& scene, const SmoothSurfaces::Groups& corners, const Joints& joints,
              const ChartConflicts& conflicts, std::vector<FlatPatches> pieces, double gap)
        : scene_(scene),
          corners_(corners),
          joints_(joints),
          conflicts_(conflicts),
          pieces_(std::move(pieces)),
          gap_(gap),
          piece_of_(scene.patches.size(), none),
          layout_of_(pieces_.size(), none),
          joints_of_(pieces_.size()) {
        for (std::uint32_t i = 0; i < pieces_.size(); ++i)
            for (const FlatPatch& flat : pieces_[i]) piece_of_[flat.patch] = i;
        for (std::uint32_t j = 0; j < joints_.size(); ++j)
            for (const EdgeIndex edge : joints_[j].edge)
                if (const std::uint32_t piece = piece_of_[edge.patch()]; piece != none) joints_of_[piece].push_back(j);
    }

    std::vector<FlatPatches> layouts() {
        std::vector<FlatPatches> all;
        for (std::uint32_t seed = 0; seed < pieces_.size(); ++seed)
            if (layout_of_[seed] == none) all.push_back(grow(seed, static_cast<std::uint32_t>(all.size())));
        return all;
    }

  private:
    /// Adds adjacent pieces to layout `number`, ring by ring. The first ring with a piece that deforms too much is the
    /// last one, because a curved surface would continue in thin strips beyond it.
    FlatPatches grow(std::uint32_t seed, std::uint32_t number) {
        layout_.clear();
        boxes_.clear();
        position_.clear();
        moments_ = {};
        is_too_curved_ = false;
        std::vector<std::uint32_t> added{seed};
        add(seed, pieces_[seed], number);
        std::size_t ring_end = added.size();
        for (std::size_t i = 0; i < added.size(); ++i) {
            if (i == ring_end) {
                if (is_too_curved_) break;
                ring_end = added.size();
            }
            for (const std::uint32_t j : joints_of_[added[i]])
                for (const EdgeIndex edge : joints_[j].edge) {
                    const std::uint32_t next = piece_of_[edge.patch()];
                    if (next == none || layout_of_[next] != none || layout_.size() >= max_patches_unfolded) continue;
                    const std::optional<FlatPatches> placed = place(next, number);
                    if (!placed || !stays_compact(*placed)) continue;
                    add(next, *placed, number);
                    added.push_back(next);
                }
        }
        return std::exchange(layout_, {});
    }

    void add(std::uint32_t piece, const FlatPatches& placed, std::uint32_t number) {
        layout_of_[piece] = number;
        for (const FlatPatch& flat : placed) {
            for (std::uint32_t c = 0; c < flat.outline().size(); ++c)
                position_.try_emplace(corners_.group[CornerIndex(flat.patch, c)], flat.corners[c]);
            place_in_layout_[flat.patch] = layout_.size();
            layout_.push_back(flat);
            moments_.add(flat);
            boxes_.push_back(flat.box());
        }
    }

    /// Returns whether the layout with a further piece is filled enough, or better than before.
    bool stays_compact(const FlatPatches& placed) const {
        Moments moments = moments_;
        for (const FlatPatch& flat : placed) moments.add(flat);
        return moments.fill() >= std::min(min_fill, moments_.fill());
    }

    /// Returns a piece moved to the current layout; nullopt if it conflicts, deforms too much or overlaps. Sets
    /// is_too_curved_ if it deforms too much, but does not close a loop.
    std::optional<FlatPatches> place(std::uint32_t piece, std::uint32_t number) {
        if (has_conflict(piece, number)) return std::nullopt;
        bool has_seams = false;
        const std::vector<PointPair> pairs = common_points(piece, number, has_seams);
        const std::optional<RigidMotion> motion = best_motion(pairs);
        if (!motion) return std::nullopt;
        FlatPatches placed = pieces_[piece];
        for (FlatPatch& flat : placed) {
            for (std::uint32_t c = 0; c < flat.outline().size(); ++c) {
                const auto known = position_.find(corners_.group[CornerIndex(flat.patch, c)]);
                flat.corners[c] = known != position_.end() ? known->second : (*motion)(flat.corners[c]);
            }
        }
        for (std::size_t i = 0; i < placed.size(); ++i) {
            // Pieces with seams must not deform, because their corners lie inside the edges of other patches.
            const bool fits = has_seams ? is_alike(pieces_[piece][i], placed[i], flat_rounding, flat_rounding)
                                        : is_alike(pieces_[piece][i], placed[i], max_stretch, max_shear);
            is_too_curved_ |= !fits && !has_seams &&
                              is_alike(pieces_[piece][i], placed[i], closing * max_stretch, closing * max_shear);
            if (!fits || !has_room(placed[i])) return std::nullopt;
        }
        return placed;
    }

    bool has_conflict(std::uint32_t piece, std::uint32_t number) const {
        const auto is_here = [&](PatchIndex patch) {
            return piece_of_[patch] != none && layout_of_[piece_of_[patch]] == number;
        };
        return std::any_of(pieces_[piece].begin(), pieces_[piece].end(), [&](const FlatPatch& flat) {
            return std::any_of(conflicts_[flat.patch].begin(), conflicts_[flat.patch].end(), is_here);
        });
    }

    /// Returns the points that a piece shares with the layout, before and after the motion.
    /// @param has_seams  Set if the piece shares parts of edges.
    std::vector<PointPair> common_points(std::uint32_t piece, std::uint32_t number, bool& has_seams) const {
        std::vector<PointPair> pairs;
        for (const FlatPatch& flat : pieces_[piece])
            for (std::uint32_t c = 0; c < flat.outline().size(); ++c)
                if (const auto known = position_.find(corners_.group[CornerIndex(flat.patch, c)]);
                    known != position_.end())
                    pairs.emplace_back(flat.corners[c], known->second);
        for (const std::uint32_t j : joints_of_[piece]) {
            const auto& [edge, from, to] = joints_[j];
            if (from[0] == 0 && to[0] == 1 && from[1] == 0 && to[1] == 1) continue;
            has_seams = true;
            const std::size_t own = piece_of_[edge[0] / 4] == piece ? 0 : 1, other = 1 - own;
            const std::uint32_t neighbour = piece_of_[edge[other] / 4];
            if (neighbour == none || layout_of_[neighbour] != number) continue;
            const FlatPatch& there = layout_[place_in_layout_.at(edge[other] / 4)];
            const auto is_here = [patch = edge[own] / 4](const FlatPatch& flat) { return flat.patch == patch; };
            const FlatPatch& here = *std::find_if(pieces_[piece].begin(), pieces_[piece].end(), is_here);
            pairs.emplace_back(on_edge(here, edge[own], from[own]), on_edge(there, edge[other], to[other]));
            pairs.emplace_back(on_edge(here, edge[own], to[own]), on_edge(there, edge[other], from[other]));
        }
        return pairs;
    }

    static Imath::V2d on_edge(const FlatPatch& flat, std::uint32_t edge, double share) {
        const std::size_t start = edge % 4, end = (start + 1) % flat.outline().size();
        return flat.corners[start] * (1 - share) + flat.corners[end] * share;
    }

    bool has_room(const FlatPatch& flat) const {
        const Imath::Box2d box = flat.box();
        const double rounding = flat_rounding * box.size().length();
        const Imath::Box2d reach(box.min - Imath::V2d(gap_), box.max + Imath::V2d(gap_));
        for (std::size_t i = 0; i < layout_.size(); ++i) {
            if (!boxes_[i].intersects(reach)) continue;
            const double distance = separation(flat, layout_[i]);
            if (distance < -rounding || (distance < gap_ && is_apart_in_space(flat, layout_[i]))) return false;
        }
        return true;
    }

    /// Returns whether two patches are farther apart in space than in the layout. The straight line between them then
    /// leaves the layout.
    bool is_apart_in_space(const FlatPatch& a, const FlatPatch& b) const {
        const double in_space = (centre(a.patch) - centre(b.patch)).length(), flat = (a.centre() - b.centre()).length();
        return in_space > (1 + max_stretch) * flat;
    }
    V3f centre(PatchIndex patch) const { return PatchGeometry(scene_, scene_.patches[patch]).centre(); }

    const Scene& scene_;
    const SmoothSurfaces::Groups& corners_;
    const Joints& joints_;
    const ChartConflicts& conflicts_;
    std::vector<FlatPatches> pieces_;
    double gap_;
    std::vector<std::uint32_t> piece_of_;                // piece of each patch
    std::vector<std::uint32_t> layout_of_;               // layout of each piece
    std::vector<std::vector<std::uint32_t>> joints_of_;  // joints of each piece

    // The current layout:
    FlatPatches layout_;
    Moments moments_;
    bool is_too_curved_ = false;  // whether a piece deformed too much
    std::vector<Imath::Box2d> boxes_;
    std::unordered_map<std::uint32_t, Imath::V2d> position_;  // position of each group of joined corners
    std::unordered_map<std::uint32_t, std::size_t> place_in_layout_;
};

}  // namespace

std::vector<FlatPatches> unfolded(const Scene& scene, const SmoothSurfaces::Groups& corners, const Joints& joints,
                                  const ChartConflicts& conflicts, std::vector<FlatPatches> pieces, double gap) {
    return Unfolding(scene, corners, joints, conflicts, std::move(pieces), gap).layouts();
}

}  // namespace interflect::detail

#include "interflect/geometry/contacts.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "interflect/base/parallel.h"
#include "interflect/geometry/box_tree.h"
#include "interflect/geometry/disjoint_sets.h"
#include "interflect/geometry/face_cutter.h"
#include "interflect/geometry/flat_surfaces.h"
#include "interflect/geometry/vertex_pool.h"

namespace interflect {

namespace {

using Imath::V2d;
using Imath::V3d;

/// What is shorter than this share of a face's diameter is not cut off it: 40 um of 10 m.
constexpr double least_detail = 4e-6;

/// Four roundings of a coordinate in single precision, relative to it.
constexpr double rounding = 0x1p-22;

/// Sine of the angle (1 degree) below which two faces that are not coplanar graze each other: no shadow ends there.
constexpr double least_angle_sine = 0.0175;

/// Strips narrower than this share of a face's diameter are not divided across.
constexpr double narrow = 2e-3;

constexpr std::size_t facets_at_once = 256;

/// A planar convex polygon of three or four corners: a face, or one of the two triangles of a warped quadrilateral.
struct Facet {
    std::uint32_t face = none;  ///< Its patch; of a two-sided face the front.
    std::array<std::uint32_t, 4> vertices{none, none, none, none};
    std::size_t count = 0;
    std::array<V3d, 4> corners;  ///< [m]
    V3d normal;                  ///< Unit length.
    double diameter = 0;         ///< [m]
    double rounding = 0;         ///< Of the corners [m].

    Facet(const Scene& scene, std::uint32_t face_index, std::span<const std::uint32_t> corner_vertices)
        : face(face_index), count(corner_vertices.size()) {
        double largest = 0;
        for (std::size_t i = 0; i < count; ++i) {
            vertices[i] = corner_vertices[i];
            corners[i] = V3d(scene.vertices[vertices[i]]);
            for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(corners[i][c]));
            for (std::size_t j = 0; j < i; ++j) diameter = std::max(diameter, (corners[i] - corners[j]).length());
        }
        rounding = interflect::rounding * largest;
        const V3d doubled = (count == 3 ? (corners[1] - corners[0]).cross(corners[2] - corners[0])
                                        : (corners[2] - corners[0]).cross(corners[3] - corners[1]));
        area_ = doubled.length() / 2;
        normal = doubled.normalized();
    }

    double area() const { return area_; }  ///< [m^2]

    double height(const V3d& x) const { return normal.dot(x - corners[0]); }
    double detail() const { return std::max(least_detail * diameter, rounding); }

    Imath::Box3f box(float margin) const {
        Imath::Box3f result;
        for (std::size_t i = 0; i < count; ++i) result.extendBy(V3f(corners[i]));
        result.min -= V3f(margin);
        result.max += V3f(margin);
        return result;
    }

  private:
    double area_ = 0;
};

/// The facets of all faces, in their order.
std::vector<Facet> facets_of(const Scene& scene) {
    std::vector<Facet> facets;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side < i) continue;
        const auto& v = patch.vertices;
        const Facet whole(scene, i, std::span(v).first(static_cast<std::size_t>(patch.vertex_count())));
        const bool is_flat = std::all_of(whole.corners.begin(), whole.corners.begin() + static_cast<long>(whole.count),
                                         [&](const V3d& x) { return std::abs(whole.height(x)) <= whole.detail(); });
        if (is_flat) {
            facets.push_back(whole);
        } else {  // as Embree does
            facets.emplace_back(scene, i, std::array{v[0], v[1], v[3]});
            facets.emplace_back(scene, i, std::array{v[2], v[3], v[1]});
        }
    }
    return facets;
}

/// A right-handed frame in a facet's plane, along its longest edge.
class PlaneFrame {
  public:
    explicit PlaneFrame(const Facet& facet) : origin_(facet.corners[0]), normal_(facet.normal) {
        double longest = 0;
        for (std::size_t i = 0; i < facet.count; ++i) {
            const V3d edge = facet.corners[(i + 1) % facet.count] - facet.corners[i];
            if (edge.length() <= longest) continue;
            longest = edge.length();
            x_ = edge.normalized();
        }
        y_ = normal_.cross(x_).normalized();
    }

    V2d in_plane(const V3d& p) const { return {x_.dot(p - origin_), y_.dot(p - origin_)}; }
    V3f in_space(const V2d& p) const { return V3f(origin_ + x_ * p.x + y_ * p.y); }

  private:
    V3d origin_, normal_, x_, y_;
};

/// A segment on a facet, and for a part of the outline of a coplanar face the side on which that face lies.
struct FoundSegment {
    PlanarSegment segment;  ///< From the lexicographically lower end.
    int outline = 0;        ///< 1 or -1: left or right of it; 0 where a face stands on the facet or passes through it.
};

/// Finds the segments in which other facets meet one facet.
class ContactFinder {
  public:
    ContactFinder(const Scene& scene, const Facet& facet, std::span<const std::uint32_t> rank, double touch_distance)
        : scene_(scene), facet_(facet), rank_(rank), touch_distance_(touch_distance), frame_(facet) {
        for (std::size_t i = 0; i < facet.count; ++i)
            polygon_.push_back({frame_.in_plane(facet.corners[i]), facet.vertices[i]});
    }

    const PlanarPolygon& polygon() const { return polygon_; }
    const PlaneFrame& frame() const { return frame_; }

    /// How far from the facet another may be to touch it [m].
    float reach() const { return static_cast<float>(std::max(touch_distance_ * facet_.diameter, 2 * facet_.rounding)); }
    bool plane_meets(const Imath::Box3f& box) const {
        const V3d centre = (V3d(box.min) + V3d(box.max)) * 0.5, half = V3d(box.max) - centre;
        const V3d& n = facet_.normal;
        const double extent = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
        return std::abs(facet_.height(centre)) <= extent + static_cast<double>(reach());
    }

    void add_contacts_with(const Facet& other) {
        if (other.face == facet_.face) return;
        const double touching =
            std::max({touch_distance_ * std::min(facet_.diameter, other.diameter), facet_.rounding, other.rounding});
        std::array<double, 4> height{};
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (std::size_t i = 0; i < other.count; ++i) {
            height[i] = facet_.height(other.corners[i]);
            lowest = std::min(lowest, height[i]);
            highest = std::max(highest, height[i]);
        }
        if (lowest > touching || highest < -touching) return;
        if (std::max(highest, -lowest) <= touching)
            add_outline(other);
        else if ((highest > touching || is_two_sided(facet_)) &&
                 facet_.normal.cross(other.normal).length() >= least_angle_sine)
            add_section(other, height, touching);
    }

    /// The segments to cut along: those that are connected to others over at least `least_extent`.
    std::vector<PlanarSegment> segments(double least_extent) {
        std::vector<PlanarSegment> all = distinct_segments();
        if (least_extent <= 0) return all;
        std::vector<std::uint32_t> chain = connected(all);
        std::vector<Imath::Box2d> extent(all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            extent[chain[i]].extendBy(all[i].a);
            extent[chain[i]].extendBy(all[i].b);
        }
        std::vector<PlanarSegment> large;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (extent[chain[i]].size().length() >= least_extent) large.push_back(all[i]);
        return large;
    }

  private:
    /// The segments, each once, without the borders between coplanar faces that hide the facet on both sides.
    std::vector<PlanarSegment> distinct_segments() {
        std::sort(found_.begin(), found_.end(), [](const FoundSegment& s, const FoundSegment& t) {
            return std::tie(s.segment.a.x, s.segment.a.y, s.segment.b.x, s.segment.b.y, s.outline) <
                   std::tie(t.segment.a.x, t.segment.a.y, t.segment.b.x, t.segment.b.y, t.outline);
        });
        std::vector<PlanarSegment> result;
        std::vector<bool> done(found_.size(), false);
        for (std::size_t i = 0; i < found_.size(); ++i) {
            if (done[i]) continue;
            bool left = found_[i].outline > 0, right = found_[i].outline < 0, stands = found_[i].outline == 0;
            for (std::size_t j = i + 1; j < found_.size() && starts_alike(i, j); ++j) {
                if (!is_same(found_[i].segment, found_[j].segment)) continue;
                done[j] = true;
                left |= found_[j].outline > 0;
                right |= found_[j].outline < 0;
                stands |= found_[j].outline == 0;
            }
            if (stands || left != right) result.push_back(found_[i].segment);
        }
        return result;
    }

    /// For each segment the lowest one of those that hang together with it by their ends.
    std::vector<std::uint32_t> connected(const std::vector<PlanarSegment>& segments) const {
        struct End {
            V2d x;
            std::uint32_t segment;
        };
        std::vector<End> ends;
        for (std::uint32_t i = 0; i < segments.size(); ++i) {
            ends.push_back({segments[i].a, i});
            ends.push_back({segments[i].b, i});
        }
        std::sort(ends.begin(), ends.end(), [](const End& p, const End& q) {
            return std::tie(p.x.x, p.x.y, p.segment) < std::tie(q.x.x, q.x.y, q.segment);
        });
        DisjointSets sets(segments.size());
        for (std::size_t i = 0; i < ends.size(); ++i)
            for (std::size_t j = i + 1; j < ends.size() && ends[j].x.x - ends[i].x.x <= facet_.detail(); ++j)
                if (std::abs(ends[j].x.y - ends[i].x.y) <= facet_.detail())
                    sets.unite(ends[i].segment, ends[j].segment);
        std::vector<std::uint32_t> chain(segments.size());
        for (std::uint32_t i = 0; i < segments.size(); ++i) chain[i] = sets.find(i);
        return chain;
    }

    bool is_two_sided(const Facet& f) const { return scene_.patches[f.face].other_side != none; }

    bool starts_alike(std::size_t i, std::size_t j) const {
        return found_[j].segment.a.x - found_[i].segment.a.x <= facet_.detail();
    }
    bool is_same(const PlanarSegment& s, const PlanarSegment& t) const {
        return (s.a - t.a).length() <= facet_.detail() && (s.b - t.b).length() <= facet_.detail();
    }

    /// @param outline  The side of the segment from a to b on which a coplanar face lies, or 0.
    void add(const V3d& a, const V3d& b, int outline) {
        PlanarSegment segment{frame_.in_plane(a), frame_.in_plane(b)};
        if (segment.b.x < segment.a.x || (segment.b.x == segment.a.x && segment.b.y < segment.a.y)) {
            std::swap(segment.a, segment.b);
            outline = -outline;
        }
        if (clip_to_interior(polygon_, facet_.detail(), segment)) found_.push_back({segment, outline});
    }

    void add_outline(const Facet& other) {
        if (rank_[other.face] > rank_[facet_.face]) return;  // this one answers rays where they overlap
        const bool opposite = facet_.normal.dot(other.normal) < 0;
        if (opposite && !is_two_sided(facet_) && !is_two_sided(other)) return;
        for (std::size_t i = 0; i < other.count; ++i)
            add(other.corners[i], other.corners[(i + 1) % other.count], opposite ? -1 : 1);
    }

    /// The other facet's intersection with this one's plane: between two corners that lie in it, or points where edges
    /// pass through it.
    void add_section(const Facet& other, const std::array<double, 4>& height, double touching) {
        std::array<V3d, 8> points;
        std::size_t count = 0;
        const auto side = [&](std::size_t i) { return (height[i] > touching) - (height[i] < -touching); };
        for (std::size_t i = 0; i < other.count; ++i) {
            const std::size_t next = (i + 1) % other.count;
            const V3d &p = other.corners[i], &q = other.corners[next];
            if (side(i) == 0) points[count++] = p;
            if (side(i) * side(next) < 0) points[count++] = p + (q - p) * (height[i] / (height[i] - height[next]));
        }
        std::pair<std::size_t, std::size_t> ends{0, 0};
        double longest = 0;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (const double length = (points[i] - points[j]).length(); length > longest) {
                    longest = length;
                    ends = {i, j};
                }
        if (longest > 0) add(points[ends.first], points[ends.second], 0);
    }

    const Scene& scene_;
    const Facet& facet_;
    std::span<const std::uint32_t> rank_;
    double touch_distance_;
    PlaneFrame frame_;
    PlanarPolygon polygon_;
    std::vector<FoundSegment> found_;
};

/// A facet in pieces; none of them where it stays whole.
struct CutFacet {
    std::vector<PlanarPolygon> patches;  ///< Of three or four corners.
    std::vector<PlanarSegment> contacts;
    bool reached_limit = false;
};

CutFacet cut_facet(ContactFinder& finder, const Facet& facet, const ContactOptions& options) {
    CutFacet result;
    std::vector<PlanarSegment> segments = finder.segments(static_cast<double>(options.least_extent));
    if (segments.empty()) return result;
    CutPolygon cut = cut_polygon(finder.polygon(), std::move(segments), facet.detail(), options.most_pieces_per_face);
    result.reached_limit = cut.reached_limit;
    result.contacts = std::move(cut.contacts);
    const PieceShape shape{static_cast<double>(options.largest_aspect),
                           std::max(2 * static_cast<double>(options.least_extent), narrow * facet.diameter)};
    if (cut.pieces.size() > 1)
        for (const PlanarPolygon& piece : cut.pieces) divide_into_patches(piece, shape, result.patches);
    return result;
}

std::vector<CutFacet> cut_facets(const Scene& scene, const std::vector<Facet>& facets, const ContactOptions& options) {
    const std::vector<std::uint32_t> rank = rank_by_flat_surface(scene);
    std::vector<Boxed> tree;
    tree.reserve(facets.size());
    for (std::uint32_t i = 0; i < facets.size(); ++i) tree.push_back({facets[i].box(0), i});
    arrange_box_tree(tree);
    std::vector<CutFacet> cut(facets.size());
    parallel_for_ranges(facets.size(), facets_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (facets[i].area() <
                static_cast<double>(options.least_extent) * static_cast<double>(options.least_extent))
                continue;
            ContactFinder finder(scene, facets[i], rank, static_cast<double>(options.touch_distance));
            const Imath::Box3f box = facets[i].box(finder.reach());
            visit_box_tree(
                std::span<const Boxed>(tree),
                [&](const Imath::Box3f& b) { return b.intersects(box) && finder.plane_meets(b); },
                [&](std::uint32_t j) { finder.add_contacts_with(facets[j]); });
            cut[i] = cut_facet(finder, facets[i], options);
        }
    });
    return cut;
}

/// Adds patches in place of a face.
class PieceWriter {
  public:
    /// @param surfaces  The number of each patch's flat surface, or none.
    PieceWriter(const Scene& scene, std::span<const std::uint32_t> surfaces, Scene& result)
        : scene_(scene), surfaces_(surfaces), result_(result), pool_(result.vertices) {}

    void add_whole(std::uint32_t face) { add_patch(face, scene_.patches[face].vertices); }

    void add_pieces(const Facet& facet, const CutFacet& cut) {
        const PlaneFrame frame(facet);
        for (const PlanarPolygon& piece : cut.patches) {
            std::array<std::uint32_t, 4> vertices{none, none, none, none};
            for (std::size_t i = 0; i < piece.size(); ++i)
                vertices[i] = piece[i].vertex != none ? piece[i].vertex : pool_.add(frame.in_space(piece[i].position));
            add_patch(facet.face, vertices);
        }
        if (cut.patches.empty()) add_patch(facet.face, facet.vertices);
        for (const PlanarSegment& s : cut.contacts)
            result_.contacts.push_back({frame.in_space(s.a), frame.in_space(s.b)});
    }

  private:
    void add_patch(std::uint32_t face, const std::array<std::uint32_t, 4>& vertices) {
        const auto index = static_cast<std::uint32_t>(result_.patches.size());
        Patch front = scene_.patches[face];
        const bool is_two_sided = front.other_side != none;
        front.vertices = vertices;
        front.surface = surfaces_[face];
        front.other_side = is_two_sided ? index + 1 : none;
        result_.patches.push_back(front);
        if (!is_two_sided) return;
        Patch back = front;
        back.other_side = index;
        std::reverse(back.vertices.begin() + 1, back.vertices.begin() + back.vertex_count());
        result_.patches.push_back(back);
    }

    const Scene& scene_;
    std::span<const std::uint32_t> surfaces_;
    Scene& result_;
    VertexPool pool_;
};

/// The facets of one face, and the number of patches that it is cut into.
struct FacetRange {
    std::size_t first, last;
    std::uint64_t patches = 0;  ///< 0: it stays whole.
};

/// Decides which faces are cut, within the limit of all patches, and reports the limits that were reached.
std::vector<FacetRange> decide(const Scene& scene, const std::vector<Facet>& facets, const std::vector<CutFacet>& cut,
                               const ContactOptions& options, Warnings& warnings) {
    std::vector<FacetRange> faces;
    std::uint64_t count = scene.patches.size();
    for (std::size_t first = 0, last; first < facets.size(); first = last) {
        last = first + 1;
        while (last < facets.size() && facets[last].face == facets[first].face) ++last;
        const std::uint64_t sides = scene.patches[facets[first].face].other_side == none ? 1 : 2;
        FacetRange& face = faces.emplace_back(FacetRange{first, last});
        bool is_cut = false;
        std::uint64_t patches = 0;
        for (std::size_t i = first; i < last; ++i) {
            is_cut |= !cut[i].patches.empty();
            patches += sides * std::max<std::size_t>(1, cut[i].patches.size());
            if (cut[i].reached_limit)
                warnings.add("contact-cuts", fmt::format("a face was cut into no more than {} pieces: elements may "
                                                         "still lie on both sides of what stands on it",
                                                         options.most_pieces_per_face));
        }
        if (!is_cut) continue;
        if (count + patches - sides <= options.most_patches) {
            face.patches = patches;
            count += patches - sides;
        } else {
            warnings.add("contact-cuts", fmt::format("a face was not cut where others meet it, for there would be "
                                                     "more than {} patches",
                                                     options.most_patches));
        }
    }
    return faces;
}

/// A number for each patch in a flat surface of which a face is cut, or which had one; none for the others.
std::vector<std::uint32_t> numbers_of_cut_surfaces(const Scene& scene, const std::vector<Facet>& facets,
                                                   const std::vector<FacetRange>& faces) {
    std::vector<std::uint32_t> surface = flat_surfaces(scene);
    std::vector<bool> is_numbered(scene.patches.size(), false);
    for (const FacetRange& face : faces)
        if (face.patches > 0) is_numbered[surface[facets[face.first].face]] = true;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i)
        if (scene.patches[i].surface != none) is_numbered[surface[i]] = true;
    for (std::uint32_t& s : surface)
        if (!is_numbered[s]) s = none;
    return surface;
}

}  // namespace

Scene cut_at_contacts(const Scene& scene, const ContactOptions& options) {
    require_no_faults(scene_faults(scene), "cannot cut the faces of", scene);
    const std::vector<Facet> facets = facets_of(scene);
    const std::vector<CutFacet> cut = cut_facets(scene, facets, options);
    Scene result = scene;
    const std::vector<FacetRange> faces = decide(scene, facets, cut, options, result.warnings);
    const std::vector<std::uint32_t> surfaces = numbers_of_cut_surfaces(scene, facets, faces);
    result.patches.clear();
    PieceWriter writer(scene, surfaces, result);
    for (const FacetRange& face : faces) {
        if (face.patches == 0)
            writer.add_whole(facets[face.first].face);
        else
            for (std::size_t i = face.first; i < face.last; ++i) writer.add_pieces(facets[i], cut[i]);
    }
    return result;
}

}  // namespace interflect

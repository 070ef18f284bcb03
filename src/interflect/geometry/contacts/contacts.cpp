#include "interflect/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/geometry/contacts/contact_finder.h"
#include "interflect/geometry/contacts/face_cutter.h"
#include "interflect/geometry/contacts/facet.h"
#include "interflect/geometry/polygons/add_face.h"
#include "interflect/geometry/search/vertex_weld.h"
#include "interflect/geometry/search/wide_box_tree.h"
#include "interflect/geometry/surfaces/flat_surfaces.h"
#include "interflect/geometry/textures/texture_mapping.h"

namespace interflect {

using namespace detail;

namespace {

/// Strips that are narrower than this share of the face's diameter are not divided across.
constexpr double narrow = 2e-3;

/// The smallest elements have half the minimum extent as their side, so they cannot resolve the light in narrower gaps.
constexpr double gap_over_min_extent = 0.5;

constexpr std::size_t facets_per_task = 256;

/// Maximum length of a sliver, relative to the width of its flat surface. This limit reduces the error of pixel blocks
/// in `slivers` (experiments/run audit) from 8.8% to 1.3%.
constexpr double longest_sliver_share = 1.0 / 16;

/// Parts of a facet. `patches` is empty if the facet stays whole.
struct CutFacet {
    std::vector<PlanarPolygon> patches;
    std::vector<PlanarSegment> contacts;
    bool reached_limit = false;
};

/// Returns the maximum length of a sliver [m]. Slivers are cut here because later quartering preserves aspect ratios.
double longest_sliver(const Facet& facet, double surface_area) {
    const double width = surface_area / facet.diameter;
    const bool is_small_part = surface_area > 4 * facet.area();
    return is_small_part ? longest_sliver_share * width : std::numeric_limits<double>::infinity();
}

CutFacet cut_facet(ContactFinder& finder, const Facet& facet, double surface_area, const ContactOptions& options) {
    CutFacet result;
    PieceShape shape{.longest_sliver = longest_sliver(facet, surface_area)};
    if (!finder.has_contacts() && std::isinf(shape.longest_sliver)) return result;
    std::vector<PlanarSegment> segments = finder.segments(static_cast<double>(options.min_extent));
    CutPolygon cut = cut_polygon(finder.polygon(), std::move(segments), facet.detail(), options.max_pieces_per_face);
    result.reached_limit = cut.reached_limit;
    result.contacts = std::move(cut.contacts);
    if (cut.pieces.size() > 1) {
        shape.largest_aspect = static_cast<double>(options.largest_aspect);
        shape.min_width = std::max(2 * static_cast<double>(options.min_extent), narrow * facet.diameter);
    }
    for (const PlanarPolygon& piece : cut.pieces) divide_into_patches(piece, shape, result.patches);
    if (result.patches.size() == 1) result.patches.clear();
    return result;
}

/// Returns, for each facet, the area of its flat surface [m^2].
std::vector<double> areas_of_surfaces(const Scene& scene, const std::vector<std::uint32_t>& surfaces,
                                      const std::vector<Facet>& facets) {
    std::vector<double> area(scene.patches.size(), 0.0), result;
    for (const Facet& facet : facets) area[surfaces[facet.face]] += facet.area();
    for (const Facet& facet : facets) result.push_back(area[surfaces[facet.face]]);
    return result;
}

/// Boxes of the facets, enlarged by the rounding errors of their corners.
WideBoxTree tree_of(const std::vector<Facet>& facets) {
    std::vector<Boxed> boxes(facets.size());
    parallel_for_indices(facets.size(), [&](std::size_t i) {
        boxes[i] = {facets[i].box(static_cast<float>(facets[i].rounding)), static_cast<std::uint32_t>(i)};
    });
    return WideBoxTree(std::move(boxes));
}

/// @param surfaces  Result of flat_surfaces().
std::vector<CutFacet> cut_facets(const Scene& scene, const std::vector<std::uint32_t>& surfaces,
                                 const std::vector<Facet>& facets, const ContactOptions& options) {
    const std::vector<std::uint32_t> rank = rank_by_flat_surface(scene, surfaces);
    const std::vector<double> surface_areas = areas_of_surfaces(scene, surfaces, facets);
    const WideBoxTree tree = tree_of(facets);
    const double gap = gap_over_min_extent * static_cast<double>(options.min_extent);
    std::vector<CutFacet> cut(facets.size());
    parallel_for_ranges(facets.size(), facets_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (facets[i].area() < static_cast<double>(options.min_extent) * static_cast<double>(options.min_extent))
                continue;
            ContactFinder finder(scene, facets[i], rank, static_cast<double>(options.touch_distance), gap);
            tree.search(
                facets[i].box(finder.reach()), [&](const Imath::Box3f& b) { return finder.plane_meets(b); },
                [&](std::uint32_t j) { finder.add_contacts_with(facets[j]); });
            cut[i] = cut_facet(finder, facets[i], surface_areas[i], options);
        }
    });
    return cut;
}

class PieceWriter {
  public:
    PieceWriter(const Scene& scene, std::span<const std::uint32_t> surfaces, Scene& result)
        : scene_(scene), surfaces_(surfaces), result_(result), weld_(result) {}

    void add_whole(std::uint32_t face) { add_patch(face, scene_.patches[face].vertices); }

    void add_pieces(const Facet& facet, const CutFacet& cut) {
        const PlaneFrame frame(facet);
        const Patch& patch = scene_.patches[facet.face];
        const PatchGeometry geometry(scene_, patch);
        const auto new_vertex = [&](const Imath::V2d& position) {
            const V3f x = frame.in_space(position);
            return weld_.vertex(x, coordinates_at(scene_, patch, geometry.parameters_of(x)));
        };
        for (const PlanarPolygon& piece : cut.patches) {
            std::array<std::uint32_t, 4> vertices{none, none, none, none};
            for (std::size_t i = 0; i < piece.size(); ++i)
                vertices[i] = piece[i].vertex != none ? piece[i].vertex : new_vertex(piece[i].position);
            add_patch(facet.face, vertices);
        }
        if (cut.patches.empty()) add_patch(facet.face, facet.vertices);
        for (const PlanarSegment& s : cut.contacts)
            result_.contacts.push_back({frame.in_space(s.a), frame.in_space(s.b)});
    }

  private:
    void add_patch(std::uint32_t face, const std::array<std::uint32_t, 4>& vertices) {
        Patch front = scene_.patches[face];
        front.vertices = vertices;
        front.surface = surfaces_[face];
        add_face(result_, front, back_material(scene_, scene_.patches[face]));
    }

    const Scene& scene_;
    std::span<const std::uint32_t> surfaces_;
    Scene& result_;
    VertexWeld weld_;
};

/// The facets of one face, from `first` to `last` - 1.
struct FacetRange {
    std::size_t first, last;
    std::uint64_t patches = 0;  ///< Number of patches on both sides; 0 if the face stays whole.
};

/// Groups the facets by face, and chooses the faces to cut within ContactOptions::max_patches.
std::vector<FacetRange> choose_cut_faces(const Scene& scene, const std::vector<Facet>& facets,
                                         const std::vector<CutFacet>& cut, const ContactOptions& options,
                                         Warnings& warnings) {
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
                                                         "still lie on both sides of objects that stand on it",
                                                         options.max_pieces_per_face));
        }
        if (!is_cut) continue;
        if (count + patches - sides <= options.max_patches) {
            face.patches = patches;
            count += patches - sides;
        } else {
            warnings.add("contact-cuts", fmt::format("a face was not cut where others meet it, for there would be "
                                                     "more than {} patches",
                                                     options.max_patches));
        }
    }
    return faces;
}

/// Returns Patch::surface of each patch: `none` unless its flat surface contains a cut face or has a number.
/// @param surface  Result of flat_surfaces().
std::vector<std::uint32_t> numbers_of_cut_surfaces(const Scene& scene, std::vector<std::uint32_t> surface,
                                                   const std::vector<Facet>& facets,
                                                   const std::vector<FacetRange>& faces) {
    std::vector<bool> is_numbered(scene.patches.size(), false);
    for (const FacetRange& face : faces)
        if (face.patches > 0) is_numbered[surface[facets[face.first].face]] = true;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (scene.patches[i].surface != none) is_numbered[surface[i]] = true;
    for (std::uint32_t& s : surface)
        if (!is_numbered[s]) s = none;
    return surface;
}

}  // namespace

Scene cut_at_contacts(const Scene& scene, const ContactOptions& options) {
    require_no_faults(scene_faults(scene), "cannot cut the faces of", scene);
    const std::vector<Facet> facets = facets_of(scene);
    std::vector<std::uint32_t> flat = flat_surfaces(scene);
    const std::vector<CutFacet> cut = cut_facets(scene, flat, facets, options);
    Scene result = scene;
    const std::vector<FacetRange> faces = choose_cut_faces(scene, facets, cut, options, result.warnings);
    const std::vector<std::uint32_t> surfaces = numbers_of_cut_surfaces(scene, std::move(flat), facets, faces);
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

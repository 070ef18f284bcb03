#include "interflect/render/sharing/light_order.h"

#include <span>
#include <type_traits>

#include "interflect/render/sharing/broadcast.h"

namespace interflect::detail {

namespace {

/// First part of a message; the camera and the gauges follow.
struct Header {
    LightOrder order;
    bool has_camera = false;
    float pixel_angle = 0, pixel_size = 0;
    std::size_t gauges = 0;
};
static_assert(std::is_standard_layout_v<Header> && std::is_standard_layout_v<Camera> &&
              std::is_standard_layout_v<Gauge>);

}  // namespace

void give_order(Ranks* ranks, LightOrder order, const PathStart& start) {
    if (!ranks || ranks->rank() != 0) return;
    Header header{order, start.camera.has_value(), start.pixel_angle, start.pixel_size, start.gauges.size()};
    broadcast(*ranks, std::span(&header, 1));
    if (start.camera) {
        Camera camera = *start.camera;
        broadcast(*ranks, std::span(&camera, 1));
    }
    std::vector<Gauge> gauges(start.gauges.begin(), start.gauges.end());
    broadcast(*ranks, std::span(gauges));
}

ReceivedOrder receive_order(Ranks& ranks) {
    Header header;
    broadcast(ranks, std::span(&header, 1));
    ReceivedOrder received{header.order, {}, {}};
    received.start.pixel_angle = header.pixel_angle;
    received.start.pixel_size = header.pixel_size;
    if (header.has_camera) {
        received.start.camera.emplace(View{}, 1, 1, Imath::V3d(0));  // overwritten by the broadcast
        broadcast(ranks, std::span(&*received.start.camera, 1));
    }
    received.gauges.resize(header.gauges);
    broadcast(ranks, std::span(received.gauges));
    received.start.gauges = received.gauges;  // remains valid if the vector is moved
    return received;
}

}  // namespace interflect::detail

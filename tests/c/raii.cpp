/* The C++ wrapper: objects can be moved and destroy themselves; failures throw, or return a status. Built both ways. */
#include "welkin.hpp"

#include <cstdio>
#include <cstring>
#include <type_traits>
#include <utility>

static_assert(!std::is_copy_constructible<welkin::device>::value, "handles never copy");
static_assert(std::is_nothrow_move_constructible<welkin::device>::value, "handles move");
static_assert(sizeof(welkin::view) == sizeof(wk_view *), "a handle is all there is");

static int fails(welkin::device &device)
{
    wk_texture_desc desc = WK_TEXTURE_DESC_INIT;
    welkin::texture texture;
    desc.width = 0;
#ifdef WELKIN_NO_EXCEPTIONS
    return texture.create(device, desc) == WK_ERROR_INVALID_ARGUMENT && !texture;
#else
    try {
        texture.create(device, desc);
    } catch (const welkin::error &e) {
        return e.status() == WK_ERROR_INVALID_ARGUMENT && e.field() == "desc.width" &&
               std::strstr(e.what(), "desc.width") && !texture;
    }
    return 0;
#endif
}

int main()
{
    wk_device *raw = nullptr;
    {
        wk_device_desc desc = WK_DEVICE_DESC_INIT;
        wk_frame frame = WK_FRAME_INIT;
        welkin::device first;
        desc.backends = WK_BACKEND_NOOP;
        if (first.create(&desc) != WK_OK) return 1;
        welkin::device device(std::move(first));
        if (first || !device) return 2;
        raw = device.get();
        welkin::context context;
        welkin::view view;
        if (context.create(device) != WK_OK || context.build_sky() != WK_OK || view.create(context) != WK_OK) return 3;
        if (context.update(1.0) != WK_OK || view.record(frame, WK_STAGE_PREPARE) != WK_OK) return 4;
        if (!fails(device)) return 5;
        wk_sea sea = WK_SEA_INIT;
        wk_sea_state state = WK_SEA_STATE_INIT;
        wk_sea_point points[2];
        const double corners_m[2][3] = {{0.0, 0.0, 0.0}, {12.0, 3.0, 0.0}};
        sea.has = WK_SEA_HAS_SEA_STATE;
        sea.sea_state = 4;
        if (context.set_sea(&sea) != WK_OK || context.set_sea_regions(nullptr, 0) != WK_OK) return 7;
        wk_sea_hull hull = WK_SEA_HULL_INIT;
        hull.speed_m_s = 5.0;
        if (context.set_sea_hulls(&hull, 1) != WK_OK) return 7;
        if (context.get_sea_state(2.0, state) != WK_OK || context.get_sea_at(corners_m, 2, 2.0, 0.0, points) != WK_OK) return 8;
        if (!points[1].has_water || points[0].height_m == points[1].height_m || !(state.significant_height_m > 1.8)) return 9;
    }
    /* Everything ended in the right order, or the device would still be alive. */
    if (wk_device_get_status(raw) != WK_ERROR_BAD_HANDLE) return 6;
    std::puts("ok");
    return 0;
}

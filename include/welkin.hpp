/*
 * Welkin for C++11 and later: handles that destroy themselves. Everything else is in welkin.h: use its structs and
 * constants as they are, and pass `device.get()`, the C handle, to calls that have no method here.
 *
 * Errors: with exceptions every method throws welkin::error on a failure and otherwise returns WK_OK or WK_PENDING.
 * Without exceptions (-fno-exceptions, or WELKIN_NO_EXCEPTIONS defined before the include) it returns the status.
 *
 * Declare children after their parents: C++ destroys them in reverse order, as the API requires.
 */
#ifndef WELKIN_HPP
#define WELKIN_HPP

#include "welkin.h"

#if !defined(WELKIN_NO_EXCEPTIONS) && !defined(__cpp_exceptions) && !defined(__EXCEPTIONS) && !defined(_CPPUNWIND)
#define WELKIN_NO_EXCEPTIONS
#endif
#ifndef WELKIN_NO_EXCEPTIONS
#include <stdexcept>
#include <string>
#endif

namespace welkin {

#ifndef WELKIN_NO_EXCEPTIONS
/* A failed call: what() is the text of wk_last_error_message, field() that of wk_last_error_field. */
class error : public std::runtime_error {
public:
    explicit error(wk_status status) : std::runtime_error(wk_last_error_message()), status_(status), field_(wk_last_error_field()) {}
    wk_status status() const noexcept { return status_; }
    const std::string &field() const noexcept { return field_; }

private:
    wk_status status_;
    std::string field_;
};
#endif

/* Throws on a failure if exceptions are in use; returns the status. */
inline wk_status checked(wk_status status)
{
#ifndef WELKIN_NO_EXCEPTIONS
    if (status < 0) throw error(status);
#endif
    return status;
}

/* Owns a handle and destroys it; can be moved, not copied. */
template <class T, wk_status (*Destroy)(T *)>
class handle {
public:
    handle() noexcept : raw_(nullptr) {}
    explicit handle(T *raw) noexcept : raw_(raw) {}
    handle(handle &&other) noexcept : raw_(other.release()) {}
    handle(const handle &) = delete;
    handle &operator=(const handle &) = delete;
    handle &operator=(handle &&other) noexcept
    {
        if (this != &other) reset(other.release());
        return *this;
    }
    ~handle() { reset(); }

    T *get() const noexcept { return raw_; }
    explicit operator bool() const noexcept { return raw_ != nullptr; }
    /* Gives the handle up without destroying it. */
    T *release() noexcept
    {
        T *raw = raw_;
        raw_ = nullptr;
        return raw;
    }
    /* Destroys the owned handle and owns `raw` instead. */
    void reset(T *raw = nullptr) noexcept
    {
        if (raw_) (void)Destroy(raw_);
        raw_ = raw;
    }

protected:
    /* Takes ownership of a handle that a wk_x_create made. */
    wk_status adopt(wk_status status, T *made)
    {
        if (status >= 0) reset(made);
        return checked(status);
    }

private:
    T *raw_;
};

class device : public handle<wk_device, wk_device_destroy> {
public:
    wk_status create(const wk_device_desc *desc = nullptr)
    {
        wk_device *made = nullptr;
        const wk_status status = wk_device_create(desc, &made);
        return adopt(status, made);
    }
    wk_status create_for_window(const wk_window &window, const wk_device_desc *desc = nullptr)
    {
        wk_device *made = nullptr;
        const wk_status status = wk_device_create_for_window(desc, &window, &made);
        return adopt(status, made);
    }
    wk_status create_opengl(const wk_opengl_host_desc &desc)
    {
        wk_device *made = nullptr;
        const wk_status status = wk_device_create_opengl(&desc, &made);
        return adopt(status, made);
    }
    wk_status create_vulkan(const wk_vulkan_host_desc &desc)
    {
        wk_device *made = nullptr;
        const wk_status status = wk_device_create_vulkan(&desc, &made);
        return adopt(status, made);
    }
    wk_status get_caps(wk_caps &caps) const { return checked(wk_device_get_caps(get(), &caps)); }
};

class texture : public handle<wk_texture, wk_texture_destroy> {
public:
    wk_status create(const device &parent, const wk_texture_desc &desc)
    {
        wk_texture *made = nullptr;
        const wk_status status = wk_texture_create(parent.get(), &desc, &made);
        return adopt(status, made);
    }
    wk_status write(const void *data, size_t size, uint32_t bytes_per_row)
    {
        return checked(wk_texture_write(get(), data, size, bytes_per_row));
    }
    wk_status read(void *data, size_t size, uint32_t bytes_per_row)
    {
        return checked(wk_texture_read(get(), data, size, bytes_per_row));
    }
};

class surface : public handle<wk_surface, wk_surface_destroy> {
public:
    wk_status create(const device &parent, const wk_window &window)
    {
        wk_surface *made = nullptr;
        const wk_status status = wk_surface_create(parent.get(), &window, &made);
        return adopt(status, made);
    }
    wk_status configure(const wk_surface_config &config) { return checked(wk_surface_configure(get(), &config)); }
    /* WK_PENDING and WK_ERROR_SURFACE_OUTDATED are normal for a window: neither throws. */
    wk_status acquire() { return unless_outdated(wk_surface_acquire(get())); }
    wk_status present() { return unless_outdated(wk_surface_present(get())); }

private:
    static wk_status unless_outdated(wk_status s) { return s == WK_ERROR_SURFACE_OUTDATED ? s : checked(s); }
};

class context : public handle<wk_context, wk_context_destroy> {
public:
    wk_status create(const device &parent, const wk_context_desc *desc = nullptr)
    {
        wk_context *made = nullptr;
        const wk_status status = wk_context_create(parent.get(), desc, &made);
        return adopt(status, made);
    }
    wk_status set_weather(const wk_weather &weather, double start_time_s, double transition_s)
    {
        return checked(wk_context_set_weather(get(), &weather, start_time_s, transition_s));
    }
    wk_status set_clock(double utc_s, double time_s) { return checked(wk_context_set_clock(get(), utc_s, time_s)); }
    wk_status set_planet(const char *planet_toml) { return checked(wk_context_set_planet(get(), planet_toml)); }
    wk_status set_tone_curve(wk_tone_curve curve) { return checked(wk_context_set_tone_curve(get(), curve)); }
    wk_status set_sky_settings(const wk_sky_settings *settings = nullptr)
    {
        return checked(wk_context_set_sky_settings(get(), settings));
    }
    /* Gets the light for the host's own objects in a frame. */
    wk_status get_frame_light(const wk_frame &frame, wk_frame_light &light) const
    {
        return checked(wk_context_get_frame_light(get(), &frame, &light));
    }
    /* WK_PENDING: steps of the simulation remain; call it again with the same time. */
    wk_status update(double time_s) { return checked(wk_context_update(get(), time_s)); }
    wk_status get_state_time(double &state_time_s) const { return checked(wk_context_get_state_time(get(), &state_time_s)); }
    /* NULL removes the sea. */
    wk_status set_sea(const wk_sea *sea) { return checked(wk_context_set_sea(get(), sea)); }
    wk_status set_sea_regions(const wk_sea_region *regions, uint32_t count)
    {
        return checked(wk_context_set_sea_regions(get(), regions, count, sizeof(wk_sea_region)));
    }
    wk_status set_sea_hulls(const wk_sea_hull *hulls, uint32_t count)
    {
        return checked(wk_context_set_sea_hulls(get(), hulls, count, sizeof(wk_sea_hull)));
    }
    /* `positions_m` has `count` positions of three numbers each, without gaps; `points` has room for as many. */
    wk_status get_sea_at(const double (*positions_m)[3], uint32_t count, double time_s, double shortest_wave_m,
                         wk_sea_point *points) const
    {
        return checked(wk_context_get_sea_at(get(), positions_m, count, sizeof(*positions_m), time_s, shortest_wave_m,
                                             points, sizeof(wk_sea_point)));
    }
    wk_status get_sea_state(double time_s, wk_sea_state &state) const
    {
        return checked(wk_context_get_sea_state(get(), time_s, &state));
    }
    wk_status build_sky(wk_progress_fn progress = nullptr, void *user = nullptr)
    {
        return checked(wk_context_build_sky(get(), progress, user));
    }
};

class view : public handle<wk_view, wk_view_destroy> {
public:
    wk_status create(const context &parent, const wk_view_desc *desc = nullptr)
    {
        wk_view *made = nullptr;
        const wk_status status = wk_view_create(parent.get(), desc, &made);
        return adopt(status, made);
    }
    wk_status record(const wk_frame &frame, wk_stage_flags stages = WK_STAGE_ALL)
    {
        return checked(wk_view_record(get(), &frame, stages));
    }
};

} // namespace welkin

#endif /* WELKIN_HPP */

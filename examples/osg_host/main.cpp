/*
 * A simulator on OpenSceneGraph with Welkin's weather. `osg_host --data ../data` opens a window; --help lists the
 * options. welkin_osg.hpp is the part to copy; light.cpp, glass.cpp, cab.cpp and weather.cpp show one feature each.
 */
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include <osg/GLExtensions>
#include <osgDB/WriteFile>
#include <osgGA/TrackballManipulator>
#include <osgViewer/CompositeViewer>

#include "../command_line.h"
#include "cab.hpp"
#include "light.hpp"
#include "state_check.hpp"
#include "weather.hpp"
#include "window.hpp"

namespace {

/* Reads the window's pixels after everything has been drawn, the presenter included. */
struct Capture : osg::Camera::DrawCallback {
    void operator()(osg::RenderInfo &info) const override
    {
        if (!wanted) return;
        const auto *window = info.getState()->getGraphicsContext();
        const int width = window->getTraits()->width, height = window->getTraits()->height;
        auto *gl = info.getState()->get<osg::GLExtensions>();
        GLint samples = 0;
        glGetIntegerv(GL_SAMPLES, &samples);
        GLuint frame = 0, color = 0;
        if (samples > 0) { /* Mesa's software driver reads one sample of a window: average them here */
            gl->glGenFramebuffers(1, &frame);
            gl->glGenRenderbuffers(1, &color);
            gl->glBindRenderbuffer(GL_RENDERBUFFER_EXT, color);
            gl->glRenderbufferStorage(GL_RENDERBUFFER_EXT, GL_RGBA8, width, height);
            gl->glBindRenderbuffer(GL_RENDERBUFFER_EXT, 0);
            gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, frame);
            gl->glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT, GL_RENDERBUFFER_EXT, color);
            gl->glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
            gl->glBindFramebuffer(GL_FRAMEBUFFER_EXT, frame);
        }
        image->readPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE);
        if (samples > 0) {
            gl->glBindFramebuffer(GL_FRAMEBUFFER_EXT, window->getDefaultFboId());
            gl->glDeleteRenderbuffers(1, &color);
            gl->glDeleteFramebuffers(1, &frame);
        }
    }
    bool wanted = false; /* changed only between frames, while all threads are stopped */
    osg::ref_ptr<osg::Image> image = new osg::Image;
};

struct CabGlass : osg::Camera::DrawCallback {
    CabGlass(const Cab *cab, welkin_osg::View *weather) : cab(cab), weather(weather) {}
    void operator()(osg::RenderInfo &info) const override
    {
        const double now = info.getState()->getFrameStamp()->getSimulationTime();
        if (wk_view *view = weather->get()) cab->set_windscreen(view, weather->weather->context(), now);
    }
    const Cab *cab;
    osg::ref_ptr<welkin_osg::View> weather;
};

/* Asks for the veil before the first frame, so that it is filled from the first frame on. */
struct AskForVeil : osg::Camera::DrawCallback {
    explicit AskForVeil(welkin_osg::View *weather) : weather(weather) {}
    void operator()(osg::RenderInfo &) const override
    {
        wk_frame_textures veil = WK_FRAME_TEXTURES_INIT;
        if (wk_view *view = weather->get()) welkin_osg::check(wk_view_get_frame_textures(view, &veil));
    }
    osg::ref_ptr<welkin_osg::View> weather;
};

/* More contrast for rain, so that trainees notice it: as in nature, hardly any shows by day (docs/rain-contrast.md). */
struct TrainersRain : osg::Camera::DrawCallback {
    explicit TrainersRain(welkin_osg::View *weather) : weather(weather) {}
    void operator()(osg::RenderInfo &) const override
    {
        wk_view *view = weather->get();
        if (!view || view == configured) return;
        wk_rain rain = WK_RAIN_INIT;
        rain.contrast_gain = WK_RAIN_GAIN_TRAINER;
        welkin_osg::check(wk_view_set_rain(view, &rain));
        configured = view;
    }
    osg::ref_ptr<welkin_osg::View> weather;
    mutable wk_view *configured = nullptr; /* read and written by the drawing thread only */
};

struct Window {
    osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
    osg::ref_ptr<welkin_osg::View> weather;
    osg::ref_ptr<StateCheck> state = new StateCheck;
    osg::ref_ptr<Capture> capture = new Capture;
};

/* The eye on the hillside above the excavator, or in the seat of another excavator beside it; x right, y ahead, z
 * up. */
osg::Matrixd seat(const world_site &site, bool cab)
{
    const double azimuth = osg::DegreesToRadians(site.azimuth_deg + (cab ? 18.0 : 3.0));
    const osg::Vec3d ahead(std::sin(azimuth), std::cos(azimuth), 0), right(ahead.y(), -ahead.x(), 0);
    osg::Vec3d eye(site.eye[0], site.eye[1], site.eye[2]);
    if (cab) {
        eye = osg::Vec3d(site.pad[0], site.pad[1], 0) - ahead * 15.0 - right * 3.0;
        eye.z() = world_height(eye.x(), eye.y()) + 2.6;
    }
    return osg::Matrixd(right.x(), right.y(), right.z(), 0, ahead.x(), ahead.y(), ahead.z(), 0, 0, 0, 1, 0, eye.x(), eye.y(), eye.z(), 1);
}

class Host {
public:
    Host(const Options &options, osg::ArgumentParser &arguments) : options_(options), viewer_(arguments) {}
    int run();

private:
    bool open();
    bool open_window_of(Window &window, int number);
    void draw(int frames, bool weather, double step_s);
    void catch_up();
    std::vector<osg::ref_ptr<osg::Image>> pictures(int frames, bool weather, double step_s);
    bool check();
    bool write();
    void resize();

    Options options_;
    osgViewer::CompositeViewer viewer_;
    world_site site_ = {};
    osg::Matrixd seat_;
    osg::Vec4 background_{0.55f, 0.60f, 0.66f, 1.0f}; /* clear colour of a program without a sky */
    osg::ref_ptr<osg::Group> scene_;
    std::unique_ptr<Cab> cab_;
    osg::ref_ptr<WeatherOfWindows> weather_;
    std::vector<Window> windows_;
    double time_s_ = 0.0;
};

bool Host::open_window_of(Window &window, int number)
{
    osg::ref_ptr<osg::GraphicsContext> context = open_window(options_, number);
    if (!context) return false;
    osg::Camera *camera = window.view->getCamera();
    camera->setGraphicsContext(context);
    camera->setViewport(0, 0, options_.width, options_.height);
    camera->setDrawBuffer(GL_BACK);
    camera->setReadBuffer(GL_BACK);
    camera->setProjectionMatrixAsPerspective(50.0, double(options_.width) / options_.height, 0.2, 1e5);
    camera->setViewMatrix(osg::Matrixd::inverse(osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)) *
                                                osg::Matrixd::rotate(-0.5 * number, osg::Vec3d(0, 0, 1)) * seat_));
    camera->setClearColor(background_);
    window.view->setSceneData(scene_);
    if (options_.out.empty() && !options_.check && !cab_) {
        osg::ref_ptr<osgGA::TrackballManipulator> hand = new osgGA::TrackballManipulator;
        const osg::Vec3d eye = seat_.getTrans(), pad(site_.pad[0], site_.pad[1], site_.pad[2] + 1.5);
        hand->setHomePosition(eye, pad, osg::Vec3d(0, 0, 1));
        window.view->setCameraManipulator(hand);
    }

    window.weather = new welkin_osg::View(weather_->of(context));
    window.weather->shown = options_.precipitation == Precipitation::Welkin;
    set_target(*window.view, options_, *window.weather);
    camera->setUserData(window.weather); /* the glass finds its veil here */
    if (options_.check) window.state->attach(window.weather, camera);
    else window.weather->attach(camera);
    camera->addPreDrawCallback(new TrainersRain(window.weather));
    camera->addPreDrawCallback(new WeatherLight(window.weather, window.view));
    if (window.weather->before_transparent) camera->addPreDrawCallback(new AskForVeil(window.weather));
    if (cab_) camera->addPreDrawCallback(new CabGlass(cab_.get(), window.weather));
    camera->addFinalDrawCallback(window.capture);
    viewer_.addView(window.view);
    return true;
}

bool Host::open()
{
    const Colors colors = options_.window_target ? Colors::Display : Colors::Linear;
    scene_ = make_scene(options_, colors, site_);
    if (!scene_) return false;
    if (options_.precipitation == Precipitation::Osg) background_ = add_osg_rain(*scene_);
    seat_ = seat(site_, options_.cab);
    if (options_.cab) {
        cab_ = std::make_unique<Cab>(seat_, colors);
        scene_->addChild(cab_->node());
    }
    weather_ = new WeatherOfWindows(options_, site_);
    world_free(); /* OSG and the weather have copies of their own */
    time_s_ = 3600.0 * options_.leap_h;
    viewer_.setRealizeOperation(weather_);
    viewer_.setThreadingModel(options_.threading);
    windows_.resize(size_t(options_.windows));
    for (size_t i = 0; i < windows_.size(); i++)
        if (!open_window_of(windows_[i], int(i))) return false;
    viewer_.realize();
    if (cab_)
        for (Window &window : windows_) cab_->set_shelter(window.weather->weather->context());
    return viewer_.isRealized() && weather_->ok;
}

void Host::draw(int frames, bool weather, double step_s)
{
    for (Window &window : windows_) window.weather->shown = weather;
    for (int i = 0; i < frames && !viewer_.done(); i++) {
        if (cab_) cab_->move_wiper(time_s_);
        viewer_.frame(time_s_);
        time_s_ += step_s;
    }
}

/* After a jump in time, a simulated ground takes more than one update. A single picture waits for it. */
void Host::catch_up()
{
    const auto lags = [](const Window &window) { return window.weather->weather->pending.load(); };
    int frames = 0;
    for (; std::any_of(windows_.begin(), windows_.end(), lags) && !viewer_.done(); frames++) draw(1, true, 0.0);
    if (frames > 0) std::cout << "the ground lagged for " << frames << " more frames" << std::endl;
}

/* Draws some frames and returns the last one of each window. */
std::vector<osg::ref_ptr<osg::Image>> Host::pictures(int frames, bool weather, double step_s)
{
    draw(frames - 1, weather, step_s);
    catch_up();
    viewer_.stopThreading(); /* data that drawing threads read may be changed only while they are stopped */
    for (Window &window : windows_) window.capture->wanted = true;
    viewer_.startThreading();
    draw(1, weather, step_s);
    viewer_.stopThreading();
    std::vector<osg::ref_ptr<osg::Image>> read;
    for (Window &window : windows_) {
        read.push_back(new osg::Image(*window.capture->image, osg::CopyOp::DEEP_COPY_ALL));
        window.capture->wanted = false;
    }
    viewer_.startThreading();
    return read;
}

double changed_share(const osg::Image &a, const osg::Image &b)
{
    if (a.s() != b.s() || a.t() != b.t()) return 1.0;
    size_t changed = 0;
    for (size_t i = 0; i < a.getTotalSizeInBytes(); i++) changed += a.data()[i] != b.data()[i];
    return double(changed) / double(a.getTotalSizeInBytes());
}

/* Draws without weather, with it, and without it again, and compares the pictures. */
bool Host::check()
{
    bool ok = true;
    const auto before = pictures(3, false, 0.0), with = pictures(options_.frames, true, 0.0), after = pictures(3, false, 0.0);
    for (size_t i = 0; i < windows_.size(); i++) {
        const StateCheck &state = *windows_[i].state;
        const double left = changed_share(*before[i], *after[i]), drawn = changed_share(*before[i], *with[i]);
        std::cout << "window " << i << ": weather changes " << 100.0 * drawn << " % of the picture, leaves " << 100.0 * left << " %; "
                  << state.values << " values of OpenGL's state in " << state.frames << " frames, " << state.changed.size() << " changed" << std::endl;
        for (size_t k = 0; k < std::min<size_t>(state.changed.size(), 20); k++) std::cout << "  " << state.changed[k] << std::endl;
        ok = ok && left == 0.0 && drawn > 0.5 && state.frames > 0 && state.values > 1000 && state.changed.empty();
    }
    uint64_t first = 0;
    for (Window &window : windows_) {
        uint64_t hash = 0;
        ok = welkin_osg::check(wk_context_state_hash(window.weather->weather->context(), &hash)) && ok;
        if (first && hash != first) std::cout << "the windows have different weather" << std::endl, ok = false;
        first = hash;
    }
    std::cout << (ok ? "ok" : "failed") << std::endl;
    return ok;
}

/* Writes one file per window: picture.png, picture-1.png. */
bool Host::write()
{
    const auto read = pictures(options_.frames, options_.precipitation == Precipitation::Welkin, 1.0 / 60.0);
    for (size_t i = 0; i < read.size(); i++) {
        std::string path = options_.out;
        if (i > 0) path.insert(path.rfind('.'), "-" + std::to_string(i));
        if (!part_end(path.c_str(), osgDB::writeImageFile(*read[i], part_begin(path.c_str())))) return false;
        std::cout << "wrote " << path << ", " << read[i]->s() << " x " << read[i]->t() << std::endl;
    }
    return true;
}

void Host::resize()
{
    draw(10, true, 1.0 / 60.0);
    for (Window &window : windows_)
        if (auto *shown = dynamic_cast<osgViewer::GraphicsWindow *>(window.view->getCamera()->getGraphicsContext()))
            shown->setWindowRectangle(0, 0, options_.width * 3 / 4, options_.height / 2);
    draw(10, true, 1.0 / 60.0); /* the window system takes some frames to respond */
}

int Host::run()
{
    bool ok = open();
    if (ok && options_.resize) resize();
    if (ok && options_.check) ok = check();
    if (ok && !options_.out.empty()) ok = write();
    if (ok && options_.out.empty() && !options_.check)
        for (int i = 0; (options_.frames == 0 || i < options_.frames) && !viewer_.done(); i++) {
            if (cab_) cab_->move_wiper(viewer_.getFrameStamp()->getSimulationTime());
            viewer_.frame(); /* simulation time follows the clock */
        }
    /* Shutdown order: drawing threads; Welkin, while the windows' contexts are alive; windows. */
    viewer_.stopThreading();
    if (options_.close_window)
        for (Window &window : windows_)
            if (auto *context = window.view->getCamera()->getGraphicsContext()) context->close(); /* null: no window */
    if (weather_) weather_->close();
    return ok ? 0 : 1;
}

} // namespace

int main(int argc, char **argv)
{
    osg::ArgumentParser arguments(&argc, argv);
    Options options;
    const int status = read_options(arguments, options);
    if (status >= 0) return status;
    return Host(options, arguments).run();
}

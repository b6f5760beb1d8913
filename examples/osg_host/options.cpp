#include "options.hpp"

#include <iostream>
#include <map>

#include "../command_line.h"

namespace {

template <class T> bool choose(const std::string &word, const std::map<std::string, T> &choices, const char *option, T &out)
{
    const auto found = choices.find(word);
    if (found != choices.end()) {
        out = found->second;
        return true;
    }
    std::cerr << option << " takes";
    for (const auto &choice : choices) std::cerr << ' ' << choice.first;
    std::cerr << ", got " << word << std::endl;
    return false;
}

} // namespace

int read_options(osg::ArgumentParser &arguments, Options &o)
{
    osg::ApplicationUsage &usage = *arguments.getApplicationUsage();
    usage.setCommandLineUsage("osg_host [options]");
    const auto option = [&](const char *name, const char *text) { usage.addCommandLineOption(name, text); return name; };
    using Viewers = osgViewer::ViewerBase;
    std::string word;
    bool ok = true;
    while (arguments.read(option("--metar", "the weather, as an airport reports it"), o.metar)) {}
    while (arguments.read(option("--hour", "hours of 21 June, UTC (17 is noon at the site)"), o.hour_utc)) {}
    while (arguments.read(option("--leap", "begin after so many hours of weather on a simulated ground"), o.leap_h)) {}
    while (arguments.read(option("--data", "folder of jacksboro_dem.png; without it the land is level"), o.data)) {}
    while (arguments.read(option("--cache", "folder in which Welkin keeps its tables"), o.cache)) {}
    while (arguments.read(option("--out", "draw some frames, write the last one to this PNG file, end"), o.out)) {}
    while (arguments.read(option("--frames", "frames to draw; 0: until the window closes"), o.frames)) {}
    while (arguments.read(option("--size", "of the window, two numbers"), o.width, o.height)) {}
    while (arguments.read(option("--windows", "1, or 2 of one CompositeViewer"), o.windows)) {}
    while (arguments.read(option("--samples", "for --msaa"), o.samples)) {}
    while (arguments.read(option("--window", "Welkin draws into the window itself; else into the camera's textures"))) o.window_target = true;
    while (arguments.read(option("--shared", "Welkin draws in a context of its own, a pbuffer's"))) o.shared = true;
    while (arguments.read(option("--reversed", "reversed float depth (textures only)"))) o.reversed = true;
    while (arguments.read(option("--cab", "from the driver's seat, behind the windscreen"))) o.cab = true;
    while (arguments.read(option("--resize", "change the window's size after the tenth frame"))) o.resize = true;
    while (arguments.read(option("--close", "close the window by force after the last frame"))) o.close_window = true;
    while (arguments.read(option("--check", "off, on, off: the same picture, and no OpenGL state changed"))) o.check = true;
    while (arguments.read(option("--msaa", "none, osg (resolved by OSG), textures (Welkin draws every sample)"), word))
        ok = choose<Msaa>(word, {{"none", Msaa::None}, {"osg", Msaa::Osg}, {"textures", Msaa::Textures}}, "--msaa", o.msaa) && ok;
    while (arguments.read(option("--precipitation", "welkin, osg (osgParticle's, with its fog), none"), word))
        ok = choose<Precipitation>(word, {{"welkin", Precipitation::Welkin}, {"osg", Precipitation::Osg}, {"none", Precipitation::None}},
                                   "--precipitation", o.precipitation) && ok;
    while (arguments.read(option("--threading", "single, context, draw or camera"), word))
        ok = choose<Viewers::ThreadingModel>(word, {{"single", Viewers::SingleThreaded},
                                                    {"context", Viewers::CullDrawThreadPerContext},
                                                    {"draw", Viewers::DrawThreadPerContext},
                                                    {"camera", Viewers::CullThreadPerCameraDrawThreadPerContext}},
                                             "--threading", o.threading) && ok;
    option("--help", "this text");
    option("--version", "Welkin's version");
    if (arguments.read("--help") || arguments.read("-h")) {
        usage.write(std::cout, osg::ApplicationUsage::COMMAND_LINE_OPTION);
        return 0;
    }
    if (command_line_answered(arguments.argc(), arguments.argv(), "osg_host", "")) return 0;
    /* The remaining arguments are unknown. */
    if (arguments.argc() > 1) return command_line_unknown("osg_host", arguments[1]);
    arguments.writeErrorMessages(std::cerr);
    if (o.window_target && o.shared) {
        std::cerr << "--window needs the host's own context: framebuffers are not shared" << std::endl;
        ok = false;
    }
    if ((!o.out.empty() || o.check) && o.frames == 0) o.frames = 12;
    return ok && !arguments.errors() ? -1 : 2;
}

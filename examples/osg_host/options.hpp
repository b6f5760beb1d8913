/* The command line's options. */
#ifndef OPTIONS_HPP
#define OPTIONS_HPP

#include <string>

#include <osg/ArgumentParser>
#include <osgViewer/ViewerBase>

enum class Msaa { None, Osg, Textures };            /* Osg: OSG's renderbuffers, resolved before Welkin draws */
enum class Precipitation { Welkin, Osg, None };

struct Options {
    std::string metar = "METAR KTRI 121800Z 24012KT 3SM +RA BKN012 OVC030 12/11 A2978";
    std::string data, out, cache;
    int width = 1280, height = 720, frames = 0, samples = 4;
    double hour_utc = 17.0, leap_h = 0.0;
    bool window_target = false, shared = false, reversed = false, cab = false, check = false, resize = false;
    bool close_window = false;
    int windows = 1;
    Msaa msaa = Msaa::Osg;
    Precipitation precipitation = Precipitation::Welkin;
    osgViewer::ViewerBase::ThreadingModel threading = osgViewer::ViewerBase::SingleThreaded;
};

/* Returns the exit status if the program should end at once: 0 after --help and --version, 2 after printing an error on
 * stderr. Returns -1 to continue. */
int read_options(osg::ArgumentParser &arguments, Options &options);

#endif

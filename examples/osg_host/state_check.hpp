/* Compares what OpenGL answers about its state before and after Welkin's part of a frame. */
#ifndef STATE_CHECK_HPP
#define STATE_CHECK_HPP

#include <osg/Camera>

#include "welkin_osg.hpp"

/* Attaches the view with one look at the state before its post-draw callback and one after it. */
class StateCheck : public osg::Referenced {
public:
    void attach(welkin_osg::View *weather, osg::Camera *camera);
    /* Values that were compared, in how many frames, and the first ones that had changed. */
    size_t values = 0;
    unsigned int frames = 0;
    std::vector<std::string> changed;

    using Values = std::vector<std::pair<std::string, std::string>>;

private:
    friend struct Look;
    Values before_;
};

#endif

/* Compares OpenGL's state before and after Welkin's part of a frame. */
#ifndef STATE_CHECK_HPP
#define STATE_CHECK_HPP

#include <osg/Camera>

#include "welkin_osg.hpp"

/* Attaches the view, and reads the state before and after its post-draw callback. */
class StateCheck : public osg::Referenced {
public:
    void attach(welkin_osg::View *weather, osg::Camera *camera);
    /* The number of values compared, the number of frames, and the values that changed. */
    size_t values = 0;
    unsigned int frames = 0;
    std::vector<std::string> changed;

    using Values = std::vector<std::pair<std::string, std::string>>;

private:
    friend struct Look;
    Values before_;
};

#endif

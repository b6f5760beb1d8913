#include "state_check.hpp"

#include <iomanip>
#include <sstream>

#include <osg/GLExtensions>

namespace {

/* OpenGL state that drawing, copying and reading pixels depend on, from the state tables of OpenGL 4.5 and of the
 * compatibility profile. */
const GLenum VALUES[] = {
    0x0B40, 0x0B45, 0x0B46, 0x0B54, 0x0B70, 0x0B72, 0x0B73, 0x0B74, 0x0B91, 0x0B92, 0x0B93, 0x0B94, 0x0B95, 0x0B96, 0x0B97, 0x0B98,
    0x0BA0, 0x0BA2, 0x0BA6, 0x0BA7, 0x0BA8, 0x0C01, 0x0C02, 0x0C10, 0x0C22, 0x0C23, 0x0B11, 0x0B21, 0x2A00, 0x8038, 0x8128, 0x8005,
    0x80C8, 0x80C9, 0x80CA, 0x80CB, 0x8009, 0x883D, 0x8800, 0x8801, 0x8802, 0x8803, 0x8CA3, 0x8CA4, 0x8CA5, 0x8E1B, 0x935C, 0x935D,
    0x0CF0, 0x0CF1, 0x0CF2, 0x0CF3, 0x0CF4, 0x0CF5, 0x806D, 0x806E, 0x0D00, 0x0D01, 0x0D02, 0x0D03, 0x0D04, 0x0D05, 0x806B, 0x806C,
    0x0D10, 0x0D11, 0x0D14, 0x0D18, 0x0D19, 0x0D1A, 0x0D1B, 0x8B8D, 0x85B5, 0x8894, 0x8895, 0x8F36, 0x8F37, 0x88ED, 0x88EF, 0x8F43,
    0x90EF, 0x8A28, 0x90D3, 0x92C1, 0x8C8F, 0x8C2A, 0x8CA6, 0x8CAA, 0x8CA7, 0x84E0, 0x84E1, 0x8F9E, 0x8E22, 0x8825, 0x8826, 0x8827,
    0x0BC1, 0x0BC2, 0x0B00, 0x0B02, 0x0B03, 0x0B61, 0x0B62, 0x0B63, 0x0B64, 0x0B65, 0x0B66, 0x0B51, 0x0B52, 0x0B53, 0x0B55, 0x0B56,
    0x80AA, 0x80AB, 0x8E4F, 0x8E72, 0x826D, 0x0BB0, 0x0BB1,
};
const GLenum SWITCHES[] = {
    0x0B10, 0x0B20, 0x0B24, 0x0B41, 0x0B42, 0x0B44, 0x0B50, 0x0B57, 0x0B60, 0x0B71, 0x0B90, 0x0BA1, 0x0BC0, 0x0BD0, 0x0BE2, 0x0BF1, 0x0BF2,
    0x0C11, 0x2A01, 0x2A02, 0x8037, 0x809D, 0x809E, 0x809F, 0x80A0, 0x8C36, 0x8E51, 0x8C89, 0x864F, 0x8F9D, 0x8DB9, 0x8642, 0x884F, 0x92E0,
    0x8074, 0x8075, 0x8076, 0x8078, 0x8620, 0x8804, 0x8458, 0x3000, 0x3001, 0x4000, 0x4001, 0x4002,
};
/* State of every texture unit: its bindings, and the switches of the fixed-function units. */
const GLenum BINDINGS[] = {0x8068, 0x8069, 0x806A, 0x84F6, 0x8514, 0x8919, 0x8C1C, 0x8C1D, 0x8C2C, 0x9104, 0x9105, 0x900A};
const GLenum UNIT_SWITCHES[] = {0x0DE0, 0x0DE1, 0x806F, 0x8513, 0x0C60, 0x0C61, 0x0C62, 0x0C63};

struct Reader {
    StateCheck::Values values;

    void add(const std::string &name, GLenum what)
    {
        GLdouble at[32];
        std::fill_n(at, 32, -77.0);
        glGetDoublev(what, at);
        if (glGetError() != GL_NO_ERROR) return; /* this context does not know it */
        std::ostringstream text;
        text << std::setprecision(17);
        for (int last = 31, i = 0; i <= last; i++) text << at[i] << ' ';
        values.emplace_back(name, text.str());
    }

    void add_switch(const std::string &name, GLenum what)
    {
        const GLboolean on = glIsEnabled(what);
        if (glGetError() == GL_NO_ERROR) values.emplace_back(name, on ? "on" : "off");
    }
};

std::string hex(const char *kind, GLenum name)
{
    std::ostringstream text;
    text << kind << " 0x" << std::hex << name;
    return text.str();
}

StateCheck::Values look(osg::State &state)
{
    while (glGetError() != GL_NO_ERROR) {} /* clears errors from before Welkin's calls */
    Reader reader;
    for (GLenum name : VALUES) reader.add(hex("value", name), name);
    for (GLenum name : SWITCHES) reader.add_switch(hex("switch", name), name);
    GLint active = 0, units = 0, fixed = 0;
    glGetIntegerv(0x84E0, &active);  /* GL_ACTIVE_TEXTURE */
    glGetIntegerv(0x8B4D, &units);   /* GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS */
    glGetIntegerv(0x84E2, &fixed);   /* GL_MAX_TEXTURE_UNITS */
    const auto *gl = state.get<osg::GLExtensions>();
    for (GLint unit = 0; unit < std::min(units, 96); unit++) {
        gl->glActiveTexture(GLenum(0x84C0 + unit));
        const std::string of = " of unit " + std::to_string(unit);
        for (GLenum name : BINDINGS) reader.add(hex("binding", name) + of, name);
        if (unit >= fixed) continue;
        for (GLenum name : UNIT_SWITCHES) reader.add_switch(hex("switch", name) + of, name);
        reader.add("texture matrix" + of, 0x0BA8);
    }
    gl->glActiveTexture(GLenum(active));
    return reader.values;
}

} // namespace

struct Look : osg::Camera::DrawCallback {
    Look(StateCheck *check, welkin_osg::View *weather, bool after) : check(check), weather(weather), after(after) {}
    void operator()(osg::RenderInfo &info) const override
    {
        if (!weather->shown) return;
        StateCheck::Values now = look(*info.getState());
        if (after) {
            check->frames++;
            check->values = now.size();
            if (now.size() != check->before_.size()) check->changed.push_back("the number of values that OpenGL knows");
            for (size_t i = 0; i < std::min(now.size(), check->before_.size()); i++)
                if (now[i] != check->before_[i])
                    check->changed.push_back(now[i].first + ": " + check->before_[i].second + " became " + now[i].second);
        } else {
            check->before_ = std::move(now);
        }
    }
    osg::ref_ptr<StateCheck> check;
    osg::ref_ptr<welkin_osg::View> weather;
    bool after;
};

void StateCheck::attach(welkin_osg::View *weather, osg::Camera *camera)
{
    camera->addPostDrawCallback(new Look(this, weather, false));
    weather->attach(camera);
    camera->addPostDrawCallback(new Look(this, weather, true));
}

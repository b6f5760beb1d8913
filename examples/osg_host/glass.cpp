/* The host's own glass: drawn in OSG's transparent bin, after Welkin's air. The veil gives the air in front of the
 * glass. */
#include <cmath>

#include <osg/BlendFunc>
#include <osg/Geometry>
#include <osg/Program>

#include "scene.hpp"
#include "welkin_osg.hpp"

namespace {

const int LIGHT_UNIT = 6, THROUGH_UNIT = 7; /* texture units that nothing else in this program uses */

const char *const VERTEX = R"(#version 130
out float far_away;
void main() {
    far_away = length((gl_ModelViewMatrix * gl_Vertex).xyz);
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
})";

/* Welkin's published veil functions are inserted before this. */
const char *const FRAGMENT = R"(
uniform sampler2D veil_light, veil_through;
uniform vec3 veil; /* light_scale; 1 / width and height of the picture */
uniform vec3 tint;
uniform bool display;
in float far_away;
vec3 decoded(vec3 x) { return mix(pow((x + 0.055) / 1.055, vec3(2.4)), x / 12.92, vec3(lessThanEqual(x, vec3(0.04045)))); }
vec3 encoded(vec3 x) { return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308)))); }
void main() {
    vec3 color = tint * (gl_LightSource[0].ambient.rgb + 0.3 * gl_LightSource[0].diffuse.rgb), through = vec3(1.0);
    vec3 light = veil.x > 0.0 ? welkin_veil(veil_light, veil_through, gl_FragCoord.xy * veil.yz, far_away, through) : vec3(0.0);
    if (display) color = decoded(color);
    color = color * through + light * veil.x;
    gl_FragColor = vec4(display ? encoded(min(color, vec3(1.0))) : color, 0.45);
})";

/* Binds the veil of the view being drawn: with two windows there are two veils. */
struct WithVeil : osg::Drawable::DrawCallback {
    void drawImplementation(osg::RenderInfo &info, const osg::Drawable *drawable) const override
    {
        osg::State &state = *info.getState();
        auto *view = dynamic_cast<welkin_osg::View *>(info.getCurrentCamera()->getUserData());
        wk_frame_textures veil = WK_FRAME_TEXTURES_INIT;
        /* Only where the air is drawn before the glass: otherwise the whole picture gets its air later, glass
         * included. */
        if (view && view->shown && (view->before_transparent & WK_STAGE_MEDIUM) && view->get())
            welkin_osg::check(wk_view_get_frame_textures(view->get(), &veil));
        const osg::Program::PerContextProgram *program = state.getLastAppliedProgramObject();
        const osg::Viewport &port = *state.getCurrentViewport();
        state.get<osg::GLExtensions>()->glUniform3f(program->getUniformLocation(osg::Uniform::getNameID("veil")),
                                                    float(veil.light_scale), 1.0f / float(port.width()), 1.0f / float(port.height()));
        bind(state, LIGHT_UNIT, veil.light);
        bind(state, THROUGH_UNIT, veil.through);
        drawable->drawImplementation(info);
    }

    static void bind(osg::State &state, int unit, uint64_t name)
    {
        state.setActiveTextureUnit(unit);
        glBindTexture(GL_TEXTURE_2D, GLuint(name));
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR); /* the host sets the texture parameters */
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
    }
};

} // namespace

osg::ref_ptr<osg::Node> make_glass(const world_site &site, Colors colors)
{
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (double away : {40.0, 160.0, 640.0, 2560.0}) { /* all look equally large */
        const double azimuth = osg::DegreesToRadians(site.azimuth_deg - 9.0 + 4.0 * std::log2(away / 40.0) / 2.0);
        const osg::Vec3d ahead(std::sin(azimuth), std::cos(azimuth), 0.0), right(ahead.y(), -ahead.x(), 0.0);
        const osg::Vec3d middle = osg::Vec3d(site.eye[0], site.eye[1], site.eye[2] - 0.012 * away) + ahead * away;
        const double half = 0.026 * away;
        for (int c = 0; c < 4; c++)
            corners->push_back(osg::Vec3(middle + right * (c == 1 || c == 2 ? half : -half) + osg::Vec3d(0, 0, c > 1 ? half : -half)));
    }
    osg::ref_ptr<osg::Geometry> panes = new osg::Geometry;
    panes->setUseDisplayList(false);
    panes->setUseVertexBufferObjects(true);
    panes->setVertexArray(corners);
    panes->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, GLsizei(corners->size())));
    panes->setDrawCallback(new WithVeil);

    const char *functions = "";
    welkin_osg::check(wk_get_veil_snippet(WK_SHADING_GLSL, &functions));
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, VERTEX));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, std::string("#version 130\n") + functions + FRAGMENT));
    osg::StateSet *state = panes->getOrCreateStateSet();
    state->setAttributeAndModes(program);
    state->setAttributeAndModes(new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA));
    state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    state->addUniform(new osg::Uniform("veil_light", LIGHT_UNIT));
    state->addUniform(new osg::Uniform("veil_through", THROUGH_UNIT));
    state->addUniform(new osg::Uniform("veil", osg::Vec3()));
    state->addUniform(new osg::Uniform("tint", osg::Vec3(0.10f, 0.22f, 0.24f)));
    state->addUniform(new osg::Uniform("display", colors == Colors::Display));
    return panes;
}

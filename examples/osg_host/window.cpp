#include "window.hpp"

#include <osg/ClipControl>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2D>
#include <osg/Texture2DMultisample>

#include <iostream>

namespace {

const char *const PRESENT_VERTEX = R"(#version 130
void main() { gl_Position = gl_Vertex; })";

/* A floating-point picture is linear after TONE, so it is encoded here; others have display values already. */
const char *const PRESENT_FRAGMENT = R"(
uniform PICTURE picture;
uniform bool linear;
vec3 encoded(vec3 x) { return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308)))); }
void main() {
    vec3 color = vec3(0.0);
    for (int i = 0; i < SAMPLES; i++) color += texelFetch(picture, ivec2(gl_FragCoord.xy), i).rgb;
    color /= float(SAMPLES);
    gl_FragColor = vec4(linear ? encoded(clamp(color, 0.0, 1.0)) : color, 1.0);
})";

/* Keeps the near and far planes that OSG computes in every frame; depth runs from 1 at the near plane to 0 at the far
 * plane. */
struct ReversedDepth : osg::CullSettings::ClampProjectionMatrixCallback {
    explicit ReversedDepth(double near_far_ratio) : ratio(near_far_ratio) {}
    bool clampProjectionMatrixImplementation(osg::Matrixf &, double &, double &) const override { return false; }
    bool clampProjectionMatrixImplementation(osg::Matrixd &projection, double &near, double &far) const override
    {
        if (far <= near) near = 0.1, far = 1e5; /* nothing in view */
        near = std::max(near, far * ratio);
        projection(2, 2) = near / (far - near);
        projection(3, 2) = near * far / (far - near);
        return true;
    }
    double ratio;
};

osg::ref_ptr<osg::Texture> make_texture(const Options &o, GLint format, GLenum pixel, GLenum type, const osg::Viewport &size)
{
    osg::ref_ptr<osg::Texture> texture;
    if (o.msaa == Msaa::Textures) {
        osg::ref_ptr<osg::Texture2DMultisample> many = new osg::Texture2DMultisample(o.samples, true);
        many->setTextureSize(int(size.width()), int(size.height()));
        texture = many;
    } else {
        osg::ref_ptr<osg::Texture2D> one = new osg::Texture2D;
        one->setTextureSize(int(size.width()), int(size.height()));
        texture = one;
    }
    texture->setInternalFormat(format);
    texture->setSourceFormat(pixel);
    texture->setSourceType(type);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

/* Shows the camera's texture in the window after the camera's post-draw callback. */
osg::ref_ptr<osg::Camera> make_presenter(osg::Texture *picture, bool linear, int samples)
{
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (float x : {-1.0f, 3.0f}) corners->push_back(osg::Vec3(x, -1, 0));
    corners->push_back(osg::Vec3(-1, 3, 0));
    osg::ref_ptr<osg::Geometry> screen = new osg::Geometry;
    screen->setVertexArray(corners);
    screen->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    screen->setCullingActive(false);

    const bool many = picture->getTextureTarget() == GL_TEXTURE_2D_MULTISAMPLE;
    const std::string head = std::string(many ? "#version 150 compatibility\n#define PICTURE sampler2DMS\n" : "#version 130\n#define PICTURE sampler2D\n") +
                             "#define SAMPLES " + std::to_string(many ? samples : 1) + "\n";
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, PRESENT_VERTEX));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, head + PRESENT_FRAGMENT));

    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setClearMask(0);
    camera->setAllowEventFocus(false);
    camera->addChild(screen);
    osg::StateSet *state = camera->getOrCreateStateSet();
    state->setAttributeAndModes(program);
    state->setTextureAttribute(0, picture);
    state->addUniform(new osg::Uniform("picture", 0));
    state->addUniform(new osg::Uniform("linear", linear));
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    state->setMode(GL_BLEND, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    return camera;
}

} // namespace

osg::ref_ptr<osg::GraphicsContext> open_window(const Options &o, int number)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    traits->x = traits->y = 40 * number;
    traits->width = o.width;
    traits->height = o.height;
    traits->windowDecoration = traits->doubleBuffer = true;
    traits->windowName = "osg_host";
    traits->depth = 24;
    if (o.window_target && o.msaa != Msaa::None) traits->samples = o.samples;
    /* If the display refuses the visual, OSG still returns a context. It is not valid, and using it crashes. */
    const auto create = [&traits] {
        osg::ref_ptr<osg::GraphicsContext> context = osg::GraphicsContext::createGraphicsContext(traits);
        return context && context->valid() ? context : nullptr;
    };
    osg::ref_ptr<osg::GraphicsContext> context = create();
    if (!context && traits->samples > 0) {
        std::cerr << "osg_host: the display has no visual with " << traits->samples << " samples; the window has one sample a pixel"
                  << std::endl;
        traits->samples = traits->sampleBuffers = 0;
        context = create();
    }
    if (!context) std::cerr << "osg_host: the display opens no window with OpenGL" << std::endl;
    return context;
}

void set_target(osgViewer::View &view, const Options &o, welkin_osg::View &weather)
{
    osg::Camera *camera = view.getCamera();
    camera->setNearFarRatio(2e-6); /* OSG's default would put the near plane at 60 m, as the land reaches 120 km */
    weather.frame.clip_space = WK_CLIP_MINUS_ONE_TO_ONE;
    weather.multisample = WK_OPENGL_MULTISAMPLE_EACH;
    /* OSG resolves its own samples after the camera has been drawn, so Welkin cannot draw the air before that. */
    if (o.window_target || o.msaa != Msaa::Osg)
        weather.before_transparent = WK_STAGE_PREPARE | WK_STAGE_BACKGROUND | WK_STAGE_SURFACE | WK_STAGE_MEDIUM;
    if (o.window_target) {
        weather.frame.color_space = WK_COLOR_DISPLAY_SRGB;
        return;
    }
    weather.frame.color_space = WK_COLOR_SCENE_LINEAR;
    const osg::Viewport &size = *camera->getViewport();
    weather.color = make_texture(o, GL_RGBA16F_ARB, GL_RGBA, GL_FLOAT, size);
    weather.depth = make_texture(o, o.reversed ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_FLOAT, size);
    const unsigned int samples = o.msaa == Msaa::Osg ? unsigned(o.samples) : 0;
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, weather.color.get(), 0, 0, false, samples, samples);
    camera->attach(osg::Camera::DEPTH_BUFFER, weather.depth.get(), 0, 0, false, samples, samples);
    /* OSG's multisampled depth is 24-bit by default, but a resolve needs equal formats. */
    if (samples) camera->getBufferAttachmentMap()[osg::Camera::DEPTH_BUFFER]._internalFormat = weather.depth->getInternalFormat();
    camera->addChild(make_presenter(weather.color.get(), true, o.samples));
    if (o.reversed) {
        weather.frame.clip_space = WK_CLIP_ZERO_TO_ONE;
        weather.frame.flags |= WK_FRAME_DEPTH_REVERSED;
        camera->setClampProjectionMatrixCallback(new ReversedDepth(2e-6));
        camera->setClearDepth(0.0);
        osg::StateSet *state = camera->getOrCreateStateSet();
        state->setAttribute(new osg::ClipControl(osg::ClipControl::LOWER_LEFT, osg::ClipControl::ZERO_TO_ONE));
        state->setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL));
    }
}

void mend_multisampling(osg::GraphicsContext &window)
{
    osg::State &state = *window.getState();
    auto *gl = state.get<osg::GLExtensions>();
    /* OSG looks this function up under another name (glTextureStorage2DMultisample), which takes a texture, not a
     * target. */
    osg::setGLExtensionFuncPtr(gl->glTexStorage2DMultisample, "glTexStorage2DMultisample");
    /* OSG takes any address as a sign of support; dispatch libraries (GLVND) return one for every function. */
    if (!osg::isGLExtensionSupported(state.getContextID(), "GL_NV_framebuffer_multisample_coverage"))
        gl->glRenderbufferStorageMultisampleCoverageNV = nullptr;
}

/*
 * Welkin in an OpenSceneGraph 3.6 camera. Copy this header; docs/hosts-openscenegraph.md is its tutorial.
 *
 *   Weather  Welkin in one graphics context. Call open() and close() while that context is current.
 *   View     Draws the weather into what one camera has drawn: its window, or the textures attached to it.
 *
 * Everything here runs on the thread that draws. It takes the matrices from osg::State: with a threaded viewer, the
 * camera's own matrices belong to another frame.
 */
#ifndef WELKIN_OSG_HPP
#define WELKIN_OSG_HPP

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/Texture>
#include <osgUtil/CullVisitor>
#include <welkin.h>

namespace welkin_osg {
inline bool check(wk_status status)
{
    if (status < WK_OK) OSG_WARN << wk_status_name(status) << ": " << wk_last_error_message() << std::endl;
    return status >= WK_OK;
}

class Weather : public osg::Referenced {
public:
    bool open(osg::GraphicsContext *gc, wk_opengl_mode mode, const wk_context_desc &place)
    {
        host_ = gc;
        if (mode == WK_OPENGL_SHARED && !open_pbuffer(gc)) return false;
        wk_opengl_host_desc desc = WK_OPENGL_HOST_DESC_INIT;
        desc.mode = mode, desc.user = this;
        desc.get_proc = [](void *, const char *name) -> const void * { return osg::getGLExtensionFuncPtr(name); };
        if (mode == WK_OPENGL_SHARED)
            desc.make_current = [](void *user, uint32_t which) -> int32_t {
                auto *self = static_cast<Weather *>(user);
                osg::GraphicsContext *gc = which == WK_OPENGL_CONTEXT_WELKIN ? self->own_.get() : self->host_.get();
                return gc && gc->isRealized() && gc->makeCurrentImplementation() ? 0 : 1;
            };
        return check(wk_device_create_opengl(&desc, &device_)) && check(wk_context_create(device_, &place, &context_));
    }

    /* Destroys children before parents. Call it before the graphics context is closed. */
    void close()
    {
        for (wk_view *view : views_) check(wk_view_destroy(view));
        views_.clear();
        check(wk_context_destroy(context_));
        check(wk_device_destroy(device_));
        context_ = nullptr, device_ = nullptr;
        /* If the window closed first, Mesa 22 may free its buffers twice when the last context that shares them
         * closes. */
        if (own_.valid() && host_.valid() && host_->isRealized()) own_->close(), own_ = nullptr;
        else own_.release();
    }

    wk_context *context() const { return context_; }
    std::atomic<bool> pending{false}; /* a simulated ground lags: keep drawing */
    wk_view *create_view()
    {
        wk_view *view = nullptr;
        return check(wk_view_create(context_, nullptr, &view)) ? views_.emplace_back(view) : nullptr;
    }

private:
    /* Creates Welkin's own context in shared mode: a pbuffer that shares objects with the window. */
    bool open_pbuffer(osg::GraphicsContext *gc)
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits(*gc->getTraits());
        traits->width = traits->height = 1, traits->pbuffer = true, traits->doubleBuffer = false, traits->samples = 0;
        traits->inheritedWindowData = nullptr, traits->sharedContext = gc;
        own_ = osg::GraphicsContext::createGraphicsContext(traits.get());
        return own_.valid() && own_->realize() && gc->makeCurrentImplementation();
    }

    osg::observer_ptr<osg::GraphicsContext> host_;
    osg::ref_ptr<osg::GraphicsContext> own_;
    wk_device *device_ = nullptr;
    wk_context *context_ = nullptr;
    std::vector<wk_view *> views_;
};

class View : public osg::Referenced {
public:
    explicit View(Weather *weather) : weather(weather) {}
    const osg::ref_ptr<Weather> weather;
    wk_frame frame = WK_FRAME_INIT;          /* set colour space, clip space and flags; View fills in the rest */
    osg::ref_ptr<osg::Texture> color, depth; /* attached to the camera; both null: the camera draws into its window */
    wk_opengl_multisample multisample = WK_OPENGL_MULTISAMPLE_EACH;
    wk_stage_flags before_transparent = 0; /* stages drawn between opaque objects and the transparent bin */
    std::atomic<bool> shown{true};

    /* Call it after setting the camera's attachments. Pre-draw callbacks added afterwards find the weather of the
     * frame's time. */
    void attach(osg::Camera *camera)
    {
        camera->addCullCallback(new Cull(this));
        camera->addPreDrawCallback(new Draw(this, &View::update));
        camera->addPostDrawCallback(new Draw(this, &View::finish));
    }

    /* The view for settings; null before the weather is opened and after it is closed. */
    wk_view *get() { return !weather->context() ? nullptr : view_ ? view_ : view_ = weather->create_view(); }

private:
    struct Draw : osg::Camera::DrawCallback {
        Draw(View *view, void (View::*step)(osg::RenderInfo &)) : view(view), step(step) {}
        void operator()(osg::RenderInfo &info) const override { (view->*step)(info); }
        const osg::ref_ptr<View> view;
        void (View::*const step)(osg::RenderInfo &);
    };

    /* Drawn in every frame after the opaque objects, even if there are none. Only at that point osg::State has the
     * camera's matrices. */
    struct Mark : osg::Drawable {
        explicit Mark(View *view) : view(view) { setUseDisplayList(false); }
        void drawImplementation(osg::RenderInfo &info) const override { view->take_camera(info); }
        View *view;
    };

    struct Cull : osg::NodeCallback {
        explicit Cull(View *view) : view(view), mark(new Mark(view))
        {
            mark->getOrCreateStateSet()->setRenderBinDetails(9, "RenderBin"); /* OSG's transparent bin is 10 */
        }
        void operator()(osg::Node *node, osg::NodeVisitor *visitor) override
        {
            traverse(node, visitor);
            osgUtil::CullVisitor *cull = visitor->asCullVisitor();
            cull->pushStateSet(mark->getStateSet());
            cull->addDrawable(mark.get(), cull->getModelViewMatrix());
            cull->popStateSet();
        }
        osg::ref_ptr<View> view;
        osg::ref_ptr<Mark> mark;
    };

    void update(osg::RenderInfo &info)
    {
        if (!get()) return;
        const wk_status status = wk_context_update(weather->context(), info.getState()->getFrameStamp()->getSimulationTime());
        weather->pending = status == WK_PENDING; /* the next frame's update continues with the remaining steps */
        report(status);
    }
    void take_camera(osg::RenderInfo &info)
    {
        const osg::State &state = *info.getState();
        const osg::Matrixd view(state.getModelViewMatrix()), projection(state.getProjectionMatrix());
        const osg::Vec3d eye = osg::Matrixd::inverse(view).getTrans();
        frame.frame_id = state.getFrameStamp()->getFrameNumber();
        std::copy_n(eye.ptr(), 3, frame.position_m);
        std::copy_n(view.ptr(), 16, frame.view); /* OSG's rows are Welkin's columns */
        std::copy_n(projection.ptr(), 16, frame.projection);
        if (before_transparent) record(info, before_transparent);
    }

    void finish(osg::RenderInfo &info) { record(info, WK_STAGE_ALL & ~before_transparent); }
    void record(osg::RenderInfo &info, wk_stage_flags stages)
    {
        if (!shown || !get()) return;
        const osg::GraphicsContext &window = *info.getState()->getGraphicsContext();
        wk_opengl_target target = WK_OPENGL_TARGET_INIT;
        target.color.kind = target.depth.kind = color.valid() ? WK_OPENGL_TEXTURE : WK_OPENGL_FRAMEBUFFER;
        target.color.name = target.depth.name = window.getDefaultFboId();
        target.width = uint32_t(window.getTraits()->width), target.height = uint32_t(window.getTraits()->height);
        if (color.valid()) {
            const unsigned int id = info.getContextID();
            osg::Texture::TextureObject *now[2] = {color->getTextureObject(id), depth->getTextureObject(id)};
            if (!now[0] || !now[1]) return;
            generation_ += now[0] != held_[0] || now[1] != held_[1]; /* OpenGL may reuse names of deleted textures */
            for (int i = 0; i < 2; i++) held_[i] = now[i];
            target.color.name = now[0]->id(), target.depth.name = now[1]->id();
            target.color.target = target.depth.target = color->getTextureTarget();
            target.width = uint32_t(now[0]->_profile._width), target.height = uint32_t(now[0]->_profile._height);
        }
        target.generation = generation_, target.multisample = multisample;
        frame.target = &target;
        if (frame.color_space != WK_COLOR_SCENE_LINEAR) stages &= ~WK_STAGE_TONE; /* the host's colours are final */
        report(wk_view_record(view_, &frame, stages));
    }

    void report(wk_status status)
    {
        if (status >= WK_OK || said_ == wk_last_error_message()) return; /* report an error once, not in every frame */
        said_ = wk_last_error_message();
        check(status);
    }

    wk_view *view_ = nullptr;
    osg::ref_ptr<osg::Texture::TextureObject> held_[2]; /* held so that no new object gets the same address */
    uint64_t generation_ = 0;
    std::string said_;
};

} // namespace welkin_osg
#endif

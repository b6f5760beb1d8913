#include "scene.hpp"

#include <cmath>

#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Program>

namespace {

/* Lit per pixel, because the triangles are large: by OpenGL's light 0, as the objects are. OpenGL's fog applies where
 * it is on. */
const char *const GROUND_VERTEX = R"(#version 130
out vec3 place, normal;
out float road, ahead;
void main() {
    place = gl_Vertex.xyz;
    normal = gl_NormalMatrix * gl_Normal;
    road = gl_MultiTexCoord0.x;
    ahead = -(gl_ModelViewMatrix * gl_Vertex).z;
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
})";

const char *const GROUND_FRAGMENT = R"(#version 130
uniform bool display, fog;
uniform vec2 pad;
in vec3 place, normal;
in float road, ahead;

float hash(ivec2 p) {
    uint h = uint(p.x) * 0x9E3779B1u ^ uint(p.y) * 0x85EBCA77u;
    h = (h ^ (h >> 15)) * 0xC2B2AE3Du;
    return float((h ^ (h >> 13)) & 0xFFFFu) / 65535.0;
}
/* Value noise that fades to its mean where it is finer than a pixel. */
float noise(float size, float pixel) {
    vec2 p = place.xy / size, f = fract(p);
    ivec2 i = ivec2(floor(p));
    f *= f * (3.0 - 2.0 * f);
    float n = mix(mix(hash(i), hash(i + ivec2(1, 0)), f.x), mix(hash(i + ivec2(0, 1)), hash(i + ivec2(1, 1)), f.x), f.y);
    return mix(n, 0.5, smoothstep(0.3, 1.0, pixel / size));
}
vec3 albedo(vec3 up) {
    float pixel = sqrt(length(dFdx(place.xy)) * length(dFdy(place.xy)));
    float fine = noise(0.3, pixel), small = noise(2.3, pixel), patch_ = noise(19.0, pixel), wide = noise(310.0, pixel);
    vec3 grass = mix(vec3(0.070, 0.095, 0.028), vec3(0.150, 0.135, 0.055), 0.5 * wide + 0.5 * patch_) * (0.55 + 0.5 * fine + 0.4 * small);
    vec3 wood = mix(vec3(0.030, 0.048, 0.020), vec3(0.085, 0.070, 0.024), wide) * (0.5 + patch_ + 0.3 * small);
    vec3 a = mix(grass, wood, smoothstep(700.0, 1000.0, length(place.xy)) * smoothstep(0.40, 0.55, wide + 0.5 * (patch_ - 0.5)));
    vec3 earth = vec3(0.155, 0.105, 0.066) * (0.6 + 0.5 * fine + 0.35 * small);
    a = mix(earth, a, smoothstep(9.0, 12.0, length(place.xy - pad) + 4.0 * (noise(3.1, pixel) - 0.5)));
    float soft = 0.7 * pixel + 0.01, d = abs(road);
    a = mix(vec3(0.21, 0.19, 0.16) * (0.7 + 0.4 * fine + 0.2 * small), a, smoothstep(4.5 - soft, 5.2 + soft, d));
    vec3 asphalt = mix(vec3(0.07) * (0.8 + 0.4 * fine), vec3(0.55), smoothstep(0.08 + soft, 0.05 - soft, abs(d - 3.2)) * smoothstep(0.5, 0.1, soft));
    return mix(asphalt, a, smoothstep(3.5 - soft, 3.6 + soft, d));
}
vec3 encoded(vec3 x) { return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308)))); }
void main() {
    vec3 n = normalize(normal), a = albedo(n);
    vec3 light = gl_LightSource[0].ambient.rgb + gl_LightSource[0].diffuse.rgb * max(dot(n, normalize(gl_LightSource[0].position.xyz)), 0.0);
    vec3 color = (display ? encoded(a) : a) * light;
    if (fog) color = mix(gl_Fog.color.rgb, color, clamp(exp(-gl_Fog.density * ahead), 0.0, 1.0));
    gl_FragColor = vec4(color, 1.0);
})";

float encoded(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f; }

osg::Vec4 shown(const osg::Vec3 &albedo, Colors colors)
{
    if (colors == Colors::Linear) return osg::Vec4(albedo, 1.0f);
    return osg::Vec4(encoded(albedo.x()), encoded(albedo.y()), encoded(albedo.z()), 1.0f);
}

osg::ref_ptr<osg::Geometry> geometry(const world_mesh &mesh, Colors colors)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> albedos = new osg::Vec4Array;
    osg::ref_ptr<osg::FloatArray> road = new osg::FloatArray;
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        const float *v = mesh.vertices + i * WORLD_FLOATS;
        positions->push_back(osg::Vec3(v[0], v[1], v[2]));
        normals->push_back(osg::Vec3(v[3], v[4], v[5]));
        albedos->push_back(shown(osg::Vec3(v[6], v[7], v[8]), colors));
        road->push_back(v[9]);
    }
    osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    made->setUseVertexBufferObjects(true);
    made->setVertexArray(positions);
    made->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    made->setColorArray(albedos, osg::Array::BIND_PER_VERTEX);
    made->setTexCoordArray(0, road);
    made->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, unsigned(mesh.index_count), mesh.indices));
    return made;
}

osg::ref_ptr<osg::Geometry> ground(const world_site &site, bool fog, Colors colors)
{
    osg::ref_ptr<osg::Geometry> made = geometry(world_ground(), colors);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, GROUND_VERTEX));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, GROUND_FRAGMENT));
    osg::StateSet *state = made->getOrCreateStateSet();
    state->setAttributeAndModes(program);
    state->addUniform(new osg::Uniform("display", colors == Colors::Display));
    state->addUniform(new osg::Uniform("fog", fog));
    state->addUniform(new osg::Uniform("pad", osg::Vec2(site.pad[0], site.pad[1])));
    return made;
}

} // namespace

osg::ref_ptr<osg::Node> make_box(const osg::Vec3d &middle, const osg::Vec3d &size, const osg::Vec3 &albedo, Colors colors)
{
    static const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(1);
    (*color)[0] = shown(albedo, colors);
    for (int axis = 0; axis < 3; axis++)
        for (float side : {-1.0f, 1.0f}) {
            osg::Vec3 normal;
            normal[axis] = side;
            for (const float *c : corner) {
                osg::Vec3 p;
                p[axis] = side, p[(axis + 1) % 3] = c[0] * side, p[(axis + 2) % 3] = c[1];
                positions->push_back(osg::Vec3(middle + osg::Vec3d(p.x() * size.x(), p.y() * size.y(), p.z() * size.z()) * 0.5));
                normals->push_back(normal);
            }
        }
    osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    made->setVertexArray(positions);
    made->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    made->setColorArray(color, osg::Array::BIND_OVERALL);
    made->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, GLsizei(positions->size())));
    return made;
}

osg::ref_ptr<osg::Group> make_scene(const Options &options, Colors colors, world_site &site)
{
    if (!world_load((options.data + "/jacksboro_dem.png").c_str(), &site)) return nullptr;
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(ground(site, options.precipitation == Precipitation::Osg, colors));
    scene->addChild(geometry(world_objects(), colors));
    scene->addChild(make_glass(site, colors));

    /* Lit by the view's light only: OpenGL's own ambient light would remain at night. */
    osg::ref_ptr<osg::LightModel> none = new osg::LightModel;
    none->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    osg::ref_ptr<osg::Material> own = new osg::Material;
    own->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    scene->getOrCreateStateSet()->setAttributeAndModes(none);
    scene->getOrCreateStateSet()->setAttributeAndModes(own);
    return scene;
}

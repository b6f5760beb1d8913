// What water on the ground needs to know of the frame.

// Classes of surface, and how water shows on one (src/ground/class.rs).
const SURFACE_CLASSES: u32 = 7u;

struct SurfaceLook {
    // Share of the darkening of wet ground.
    soaks: f32,
    // Share of it that a closed film covers.
    film: f32,
    // Root mean square slope of what the film lies on, beyond the film's own.
    slope: f32,
    // Depth at which standing water is level over most of it, mm; 0 keeps none.
    relief_mm: f32,
    // Largest albedo that its colour is taken for.
    most_albedo: f32,
    // Share of the pattern's puddles that it has.
    hollows: f32,
    // How sure it is that it lies level, where nothing else says how it lies.
    level: f32,
    // Share of it on which snow lies.
    snow: f32,
}

struct GroundUniform {
    // Unit, towards the lamp that lights the ground, as it appears.
    to_lamp: vec3f,
    // Share of the ground's pores that hold water.
    soaked: f32,
    // Its illuminance on a surface that faces it, lux a channel.
    lamp_lux: vec3f,
    // Level of standing water in the hollows, in units of their root mean square depth.
    level: f32,
    // Sky, clouds and fog on level ground, lux a channel.
    sky_lux: vec3f,
    // Share of that light that enters water.
    entering: f32,
    // Luminance of the lit ground round about, cd/m^2 a channel: what mirrors that face down see.
    ground_light: vec3f,
    // As `level`, of a film: above it the ground is bare.
    film_level: f32,
    // Axes of the pattern of hollows, and where the camera stands in a cell of the rings' grid, m.
    axis_u: vec3f,
    place_u: f32,
    axis_v: vec3f,
    place_v: f32,
    // That cell; the rings' slot of time, the share of it that has passed.
    cell: vec2u,
    slot: u32,
    slot_share: f32,
    // Of the film's and the standing water's slopes, root mean square along one axis.
    film_slope: f32,
    water_slope: f32,
    // Chance that a drop falls into a cell of the rings' grid in a slot of time.
    ring_chance: f32,
    // Most light that is added, cd/m^2: what a half float holds.
    most: f32,
    // Steps of ndc to the next pixel to the right and below.
    pixel: vec2f,
    // Rounding of the host's depth: absolute, and over its value.
    depth_step: f32,
    depth_ulp: f32,
    // 1/(planet radius + altitude), 1/m; 0 for a flat world.
    curvature: f32,
    // Mean square slope of the rings where they are too small to be seen.
    ring_slope2: f32,
    // (Radius of the lamp's disc / 4)^2, rad^2.
    disc2: f32,
    // Share of level ground under clear ice.
    glaze: f32,
    // Of the air that carries the rain, m/s.
    wind: vec3f,
    // Optical depth of the fog straight up.
    fog_depth: f32,
    // Fall speeds of the drops in the middle of each twelfth of the water, m/s, slow ones first.
    falls: array<vec4f, 3>,
    // On the host's terrain: from camera-relative east, north and up to cells east and north of its first node and to
    // metres above its origin.
    terrain_x: vec4f,
    terrain_y: vec4f,
    terrain_z: vec4f,
    // Its last node, cells from its border within which it gives way to the world's ground, and how far off it, m, a
    // surface may lie that is still its own.
    terrain_last: vec2f,
    terrain_rim: f32,
    terrain_near: f32,
    // Rows that turn normals of the host's image to east, north, up; w: what its numbers are multiplied by, and added
    // to that.
    normal_x: vec4f,
    normal_y: vec4f,
    normal_z: vec4f,
    // Snow on level, open ground. x: level in the hollows up to which it covers them. y: wetness. z: albedo. w: depth,
    // m; -1 where no cell of the terrain has snow of its own.
    snow: vec4f,
    // Of each class; the first one is the context's default.
    looks: array<SurfaceLook, SURFACE_CLASSES>,
    // Of the waves of hollows at the camera, turns.
    phases: array<vec4f, 4>,
}

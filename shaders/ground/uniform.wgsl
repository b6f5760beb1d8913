// Uniform block of the ground in a frame.

// Number of surface classes (src/ground/class.rs).
const SURFACE_CLASSES: u32 = 7u;

// Look of water on a surface class, in the layout of `SurfaceLook` of src/ground/class.rs.
struct SurfaceLook {
    // Share of the darkening of wet ground that the class shows.
    soaks: f32,
    // Share of the ground that a closed film covers.
    film: f32,
    // Root mean square slope, along one axis, of the ground under the film, beyond the film's own slope.
    slope: f32,
    // Scale of the ground's relief, mm: standing water begins to cover the relief at 0.2 of this depth and covers all
    // of it at twice this depth. With 0 no standing water is drawn.
    relief_mm: f32,
    // Upper limit of the albedo estimated from the host's colour.
    most_albedo: f32,
    // Share of the pattern's puddles that the class has.
    hollows: f32,
    // Confidence that the ground is level, 0 to 1, used if neither terrain, normals nor depth give its slope.
    level: f32,
    // Factor on the share of the ground that lying snow covers: 0 on water, 1 on other classes.
    snow: f32,
}

// Block of the ground. Vectors without another note are (east, north, up).
struct GroundUniform {
    // Unit vector towards the apparent position of the lamp that lights the ground (sun or moon).
    to_lamp: vec3f,
    // Share of the ground's pores that hold water.
    soaked: f32,
    // Illuminance of the lamp on a surface that faces it, lux per channel.
    lamp_lux: vec3f,
    // Level of standing water: hollows deeper than this hold water, in units of their root mean square depth.
    level: f32,
    // Illuminance of sky, clouds and fog on level ground, lux per channel.
    sky_lux: vec3f,
    // Share of the light on level ground that enters water.
    entering: f32,
    // Luminance of the lit ground around, cd/m^2 per channel, which downward reflections show.
    ground_light: vec3f,
    // Level of the film: ground less deep than this is bare, in units of the hollows' root mean square depth.
    film_level: f32,
    // Axes of the pattern of hollows, (east, north, up), and the camera's place along each in its cell of the rings'
    // grid, m.
    axis_u: vec3f,
    place_u: f32,
    axis_v: vec3f,
    place_v: f32,
    // Cell of the rings' grid in which the camera is.
    cell: vec2u,
    // Time slot of the rings.
    slot: u32,
    // Share of the slot that has passed.
    slot_share: f32,
    // Root mean square slopes, along one axis, of the film and of standing water.
    film_slope: f32,
    water_slope: f32,
    // Chance that a drop falls into a cell of the rings' grid in a time slot.
    ring_chance: f32,
    // Limit of the light that is added, cd/m^2: the value at which the host's target, as half floats, nearly overflows.
    most: f32,
    // Steps in normalised device coordinates to the next pixel to the right and below.
    pixel: vec2f,
    // Rounding error of the host's depth: absolute, and relative to the value.
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
    // Velocity of the air that carries the rain, (east, north, up), m/s.
    wind: vec3f,
    // Optical depth of the fog straight up.
    fog_depth: f32,
    // Fall speeds of the drops in the middle of each twelfth of the rain's water, m/s, from slow to fast.
    falls: array<vec4f, 3>,
    // Rows that map camera-relative east, north and up to the host's terrain: cells east and north of its first node,
    // and metres above its origin.
    terrain_x: vec4f,
    terrain_y: vec4f,
    terrain_z: vec4f,
    // Indices of the terrain's last node, east and north.
    terrain_last: vec2f,
    // Width of the border zone in which the terrain fades into the world's ground, cells.
    terrain_rim: f32,
    // Largest distance from the terrain, m, of a surface that still belongs to it.
    terrain_near: f32,
    // Rows that turn normals of the host's image to east, north, up. w of `normal_x` is the scale and w of `normal_y`
    // the offset that decode the stored numbers.
    normal_x: vec4f,
    normal_y: vec4f,
    normal_z: vec4f,
    // Snow on level, open ground. x: level in the hollows up to which the snow covers the ground. y: wetness. z:
    // albedo. w: depth, m; -1 if the terrain's cells have no snow of their own.
    snow: vec4f,
    // x: height of the highest crests of the drawn sea, camera-relative, m. Surfaces below it count as the sea. Without
    // a drawn sea it is -1e9.
    sea: vec4f,
    // Look of each class; the first one is the context's default.
    looks: array<SurfaceLook, SURFACE_CLASSES>,
    // Phases of the hollows' waves at the camera, turns.
    phases: array<vec4f, 4>,
}

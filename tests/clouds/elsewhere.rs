//! Clouds outside the main draw of a picture: in mirrors, in the cube map, in front of the host's own transparent
//! objects, and in a picture that is drawn stage by stage.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    frame::{Exposure, Frame, FrameFlags, Stages},
    gpu::readback,
    ground::{
        SurfaceClass,
        reference::{fresnel_water, normal_quantile},
    },
    light::luminance,
    scene::Camera,
    sky::sun::direction,
    weather::{Surface, SurfaceState, Weather, Wind},
};

use crate::drawn::{BROKEN, CLOSED, SIZE, Sky};

/// Writes the depth of a level plane below a camera that looks along `forward`; without ground the sky is open.
fn write_depth(sky: &Sky, depth: &wgpu::Texture, camera: &Camera) {
    let inverse = camera.projection.inverse();
    let at = |i: u32| {
        let uv = [(i % SIZE.0, SIZE.0), (i / SIZE.0, SIZE.1)].map(|(p, of)| (f64::from(p) + 0.5) / f64::from(of));
        let eye = inverse.project_point3(DVec3::new(2.0 * uv[0] - 1.0, 1.0 - 2.0 * uv[1], 0.5)).normalize();
        let d = camera.rotation().transpose() * eye;
        let range = -camera.position.z / d.z;
        if d.z < -1e-4 { (0.1 / (range * -eye.z)) as f32 } else { 0.0 }
    };
    let texels: Vec<f32> = (0..SIZE.0 * SIZE.1).map(at).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
    sky.device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, depth.size());
}

impl Sky {
    /// Draws the stages of a frame in calls of their own over a host's black picture.
    fn draw(&mut self, camera: Camera, depth: Option<&wgpu::Texture>, calls: &[Stages]) -> Vec<[f64; 3]> {
        let black = vec![0u8; 16 * (SIZE.0 * SIZE.1) as usize];
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * SIZE.0), rows_per_image: None };
        self.device.queue.write_texture(self.color.as_image_copy(), &black, layout, self.color.size());
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, camera, &self.color, depth);
        // A frame with the stage SURFACE alone keeps the clouds of all directions from the frame before.
        let shows = calls.iter().any(|stages| *stages != Stages::SURFACE);
        frame.flags = if shows { FrameFlags::NO_HISTORY } else { FrameFlags(0) };
        frame.exposure = Some(Exposure::Factor(1e-4));
        for stages in calls {
            self.view.record(&self.context, &frame, *stages).unwrap();
        }
        let texels = readback::rgba(&self.device, &self.color).unwrap();
        texels.iter().map(|t| [0, 1, 2].map(|k| f64::from(t[k]))).collect()
    }

    /// Level paved ground under water.
    fn flood(&mut self, report: &str) {
        let clouds = Weather::from_metar(report).unwrap().weather.clouds;
        let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
        let weather = Weather { surface, clouds, wind: Wind::of(0.0, 0.0), ..Weather::default() };
        self.context.set_weather(&weather, 0.0, 0.0).unwrap();
        self.context.set_default_surface_class(SurfaceClass::Paved);
    }

    /// A place in the middle of a puddle.
    fn puddle(&self) -> DVec3 {
        let level = normal_quantile(1.0 - 0.3);
        let deep = |at: &DVec3| self.context.hollows().depth(at.truncate()) - level;
        let places = (0..10_000).map(|i| DVec3::new(f64::from(i % 100), f64::from(i / 100), 0.0) * 0.5);
        places.max_by(|a, b| deep(a).total_cmp(&deep(b))).unwrap()
    }
}

fn look(at: DVec3, azimuth_deg: f64, elevation_deg: f64, fov: f64) -> Camera {
    Camera::look_to(at, direction(azimuth_deg, elevation_deg), DVec3::Z, fov, 16.0 / 9.0, 0.1)
}

const SKY: [Stages; 1] = [Stages::BACKGROUND];

#[test]
fn a_puddle_mirrors_the_clouds_that_stand_over_it() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    sky.flood(BROKEN);
    let (puddle, elevation) = (sky.puddle(), 35f64);
    let depth = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::R32Float, 1);
    let middle = (SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize;
    let (mut mirrored, mut seen) = (Vec::new(), Vec::new());
    let sun = sky.context.light_at(puddle, sky.context.time_s()).unwrap().sun.apparent;
    for azimuth in (0..48).map(|i| 7.5 * f64::from(i)) {
        // The mirror reflects the sun as a lamp; only the picture has the sun's disc.
        if direction(azimuth, elevation).angle_between(sun) < 0.1 {
            continue;
        }
        let eye = puddle - direction(azimuth, -elevation);
        let down = look(eye, azimuth, -elevation, 0.02);
        write_depth(&sky, &depth, &down);
        let water = luminance(&sky.draw(down, Some(&depth), &[Stages::SURFACE])[middle]);
        // The mean over as much of the sky as a texel of 1.5 degrees shows.
        let patch = sky.draw(look(eye, azimuth, elevation, 0.026), None, &SKY);
        let over = patch.iter().map(luminance).sum::<f64>() / patch.len() as f64;
        mirrored.push(water / fresnel_water(elevation.to_radians().sin()));
        seen.push(over);
    }
    let broken = seen.iter().fold(0.0, |m: f64, v| m.max(*v)) / seen.iter().fold(f64::INFINITY, |m: f64, v| m.min(*v));
    assert!(broken > 5.0, "the sky is broken: {seen:.0?}");
    agree("mirrored", &mirrored, &seen);
}

/// Checks that a view in texels of 1.5 degrees has the light and the clouds of pictures, except at the edges of clouds.
fn agree(name: &str, shown: &[f64], drawn: &[f64]) {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let logs = |v: &[f64]| v.iter().map(|v| v.ln()).collect::<Vec<_>>();
    let (a, b) = (logs(shown), logs(drawn));
    let (ma, mb) = (mean(&a), mean(&b));
    let with = |x: &[f64], mx: f64, y: &[f64], my: f64| x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>();
    let follows = with(&a, ma, &b, mb) / (with(&a, ma, &a, ma) * with(&b, mb, &b, mb)).sqrt();
    let mut off: Vec<f64> = shown.iter().zip(drawn).map(|(a, b)| (a / b - 1.0).abs()).collect();
    off.sort_by(f64::total_cmp);
    let (light, median) = (mean(shown) / mean(drawn), off[off.len() / 2]);
    println!("{name}: correlation {follows:.3}, light {light:.3}, off by {median:.3} in the median of {}", off.len());
    assert!(follows > 0.85, "{follows}");
    assert!((light - 1.0).abs() < 0.15, "{light}");
    assert!(median < 0.03, "{median}");
}

#[test]
fn the_cube_map_shows_the_clouds_of_the_picture() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    sky.view.environment().unwrap();
    let camera = look(DVec3::Z * 2.0, 0.0, 30.0, 1.0);
    let picture = sky.draw(camera, None, &[Stages::BACKGROUND.with(Stages::MEDIUM)]);
    let map = sky.view.environment().unwrap();
    let texels = welkin_support::cube_lookup::faces(&sky.device, &map.texture, 64, 0);
    let clip = camera.projection * glam::DMat4::from_mat3(camera.rotation());
    // The face towards +Y, which is north: its right is +X, its lower edge +Z (OpenGL 4.6, table 8.19).
    let (mut cube, mut seen) = (Vec::new(), Vec::new());
    for i in 0..64 * 64usize {
        let [x, y] = [i % 64, i / 64].map(|p| (2.0 * p as f64 + 1.0) / 64.0 - 1.0);
        let d = DVec3::Y + x * DVec3::X + y * DVec3::Z;
        let ndc = clip * d.extend(1.0);
        let at = ndc.truncate() / ndc.w;
        if ndc.w <= 0.0 || at.x.abs() > 0.95 || at.y.abs() > 0.95 || d.normalize().z < 0.35 {
            continue;
        }
        let pixel =
            [(0.5 + 0.5 * at.x) * f64::from(SIZE.0), (0.5 - 0.5 * at.y) * f64::from(SIZE.1)].map(|v| v as usize);
        let drawn = luminance(&picture[pixel[1] * SIZE.0 as usize + pixel[0]]);
        let texel = texels[i / 64 * 6 * 64 + 2 * 64 + i % 64];
        let shown = luminance(&[0, 1, 2].map(|k| f64::from(texel[k]) * map.cd_m2_per_unit));
        cube.push(shown);
        seen.push(drawn);
    }
    agree("cube map", &cube, &seen);
}

#[test]
fn a_picture_drawn_stage_by_stage_is_the_one_of_one_call() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    sky.flood(BROKEN);
    let depth = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::R32Float, 1);
    let camera = look(DVec3::Z * 30.0, 100.0, -4.0, 1.0);
    write_depth(&sky, &depth, &camera);
    let (behind, surface, between) = (Stages::BACKGROUND, Stages::SURFACE, Stages::MEDIUM);
    let one = sky.draw(camera, Some(&depth), &[behind.with(surface).with(between)]);
    for (calls, has_cube) in [
        (&[behind, surface, between][..], false),
        (&[behind.with(surface), between], false),
        (&[behind, surface, between], true),
    ] {
        // A cube map asks for the clouds of all directions in the first call.
        if has_cube {
            sky.view.environment().unwrap();
        }
        let apart = sky.draw(camera, Some(&depth), calls);
        let most = one
            .iter()
            .zip(&apart)
            .map(|(a, b)| (luminance(b) / luminance(a).max(1e-3) - 1.0).abs())
            .fold(0.0, f64::max);
        println!("{} calls: off by {most:.2e} at most", calls.len());
        assert!(most < 1e-3, "{most}");
    }
}

#[test]
fn in_a_cloud_the_hosts_own_transparent_things_fade_as_the_picture_does() {
    let mut sky = Sky::new(CLOSED, CloudModel::Volume);
    let base_m = 914.4;
    sky.view.frame_textures().unwrap();
    let camera = look(DVec3::Z * (base_m + 200.0), 0.0, 0.0, 1.0);
    sky.draw(camera, None, &[Stages::BACKGROUND.with(Stages::MEDIUM)]);
    let textures = sky.view.frame_textures().unwrap();
    let through = readback::rgba(&sky.device, &textures.through).unwrap();
    // Transmittance in the middle of the picture, at the slice nearest to a distance.
    let at = |distance: f64| {
        let slice = ((distance / 20.0 + 1.0).ln() * 3.639_611_2).round();
        let (x, y) = ((slice % 8.0) * 32.0 + 16.0, (slice / 8.0).floor() * 18.0 + 9.0);
        f64::from(through[y as usize * 256 + x as usize][1])
    };
    println!("through a cloud: {:.2} of the light at 20 m, {:.4} at 1 km", at(20.0), at(1000.0));
    assert!(at(1000.0) < 0.02 && at(20.0) > at(1000.0));
}

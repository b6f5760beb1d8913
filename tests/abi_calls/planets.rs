//! Planets with haze of their own, and what may be changed on a living context with views: planet, tone curve, sky
//! settings. A picture after a change is that of a context which was created so, to the bit. On a device that computes.

use std::{
    ffi::{CString, c_char},
    ptr::{null, null_mut},
};

use welkin::capi::{
    context::*, device::*, frame::*, query::*, sky::*, status::*, texture::*, timeline::*, view::*, weather::*,
};

use super::world::{World, init, message};

const DUSTY: &str = include_str!("../../examples/data/planet_dusty.toml");
const SIZE: [u32; 2] = [32, 18];

fn ok(status: wk_status) {
    assert_eq!(status, WK_OK, "{}", message());
}

/// The quickest tables: two models, to change between.
fn sky(model: wk_sky_model) -> wk_sky_settings {
    wk_sky_settings { model, suns: 16, altitudes: 8, ..init("wk_sky_settings") }
}

/// A context, a view of it and an image.
struct Scene {
    context: *mut wk_context,
    view: *mut wk_view,
    color: *mut wk_texture,
    frames: u64,
}

impl Scene {
    fn new(device: *mut wk_device, planet: Option<&CString>, tone_curve: wk_tone_curve, sky: &wk_sky_settings) -> Self {
        let mut scene = Self { context: null_mut(), view: null_mut(), color: null_mut(), frames: 0 };
        let planet_toml: *const c_char = planet.map_or(null(), |p| p.as_ptr());
        let next = std::ptr::from_ref(sky).cast();
        let desc = wk_context_desc { planet_toml, tone_curve, next, ..init("wk_context_desc") };
        let image = wk_texture_desc { width: SIZE[0], height: SIZE[1], ..init("wk_texture_desc") };
        // SAFETY: live pointers.
        unsafe {
            ok(wk_context_create(device, &desc, &mut scene.context));
            ok(wk_view_create(scene.context, null(), &mut scene.view));
            ok(wk_texture_create(device, &image, &mut scene.color));
        }
        scene
    }

    fn set_visibility(&self, visibility_m: f64) {
        let weather = wk_weather { visibility_m, ..init("wk_weather") };
        // SAFETY: live pointers.
        ok(unsafe { wk_context_set_weather(self.context, &weather, 0.0, 0.0) });
    }

    /// Draws the sky to the north, independent of earlier frames.
    fn picture(&mut self) -> Vec<[u8; 4]> {
        let target = wk_own_target { color: self.color, ..init("wk_own_target") };
        self.frames += 1;
        let frame = wk_frame {
            frame_id: self.frames,
            position_m: [0.0, 0.0, 2.0],
            view: [1., 0., 0., 0., 0., 0., -1., 0., 0., 1., 0., 0., 0., 0., 0., 1.],
            projection: [1.83, 0., 0., 0., 0., 3.25, 0., 0., 0., 0., 0., -1., 0., 0., 0.1, 0.],
            flags: WK_FRAME_DEPTH_REVERSED | WK_FRAME_NO_HISTORY,
            color_space: WK_COLOR_DISPLAY_SRGB,
            target: (&raw const target).cast(),
            ..init("wk_frame")
        };
        let mut texels = vec![[0_u8; 4]; (SIZE[0] * SIZE[1]) as usize];
        // SAFETY: live pointers with the sizes given.
        unsafe {
            ok(wk_view_record(self.view, &frame, WK_STAGE_BACKGROUND | WK_STAGE_PREPARE));
            ok(wk_texture_read(self.color, texels.as_mut_ptr().cast(), 4 * texels.len(), 4 * SIZE[0]));
        }
        texels
    }

    /// Returns the transmittance over 10 km at 680, 550 and 440 nm.
    fn left_over_10_km(&self) -> [f64; 3] {
        let segment = wk_segment { from_m: [0.0, 0.0, 2.0], to_m: [0.0, 10_000.0, 2.0] };
        let mut between = wk_between { transmittance: [0.0; 3], visibility_m: 0.0 };
        let sizes = [size_of::<wk_segment>() as u32, size_of::<wk_between>() as u32];
        // SAFETY: live pointers with the sizes given.
        ok(unsafe { wk_context_get_between(self.context, &segment, 1, sizes[0], &mut between, sizes[1]) });
        between.transmittance
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: live handles.
        unsafe {
            assert_eq!(wk_texture_destroy(self.color), WK_OK);
            assert_eq!(wk_view_destroy(self.view), WK_OK);
            assert_eq!(wk_context_destroy(self.context), WK_OK);
        }
    }
}

fn device() -> *mut wk_device {
    let mut device = null_mut();
    // SAFETY: live pointers.
    ok(unsafe { wk_device_create(&init::<wk_device_desc>("wk_device_desc"), &mut device) });
    device
}

/// Mean red over mean blue of the picture's upper half: the sky.
fn red_over_blue(picture: &[[u8; 4]]) -> f64 {
    let sky = &picture[..picture.len() / 2];
    let mean = |c: usize| sky.iter().map(|p| f64::from(p[c])).sum::<f64>();
    mean(0) / mean(2)
}

#[test]
fn a_planets_own_haze_is_drawn_beside_the_weathers() {
    let device = device();
    let (from, to) = (DUSTY.find("[mie]").unwrap(), DUSTY.find("[absorption]").unwrap());
    let dusty = CString::new(DUSTY).unwrap();
    let without = CString::new([&DUSTY[..from], &DUSTY[to..]].concat()).unwrap();
    {
        let model = sky(WK_SKY_ISOTROPIC);
        let mut scenes = [&dusty, &without].map(|p| Scene::new(device, Some(p), WK_TONE_EXPONENTIAL, &model));
        // Air so clear that the weather has no haze: all of it is the planet's.
        scenes.iter().for_each(|s| s.set_visibility(1e6));
        let [own, none] = scenes.each_ref().map(Scene::left_over_10_km);
        for i in 0..3 {
            assert!((own[i] / none[i] / (-4.5e-5 * 1e4_f64).exp() - 1.0).abs() < 1e-3, "{own:?} {none:?}");
        }
        let [hazy, clear] = scenes.each_mut().map(|s| red_over_blue(&s.picture()));
        assert!(hazy > 1.2 && clear < 0.8, "dust makes the sky red: {hazy} {clear}");
        // The weather's haze adds to it.
        scenes.iter().for_each(|s| s.set_visibility(20_000.0));
        let [both, weathers] = scenes.each_ref().map(Scene::left_over_10_km);
        for i in 0..3 {
            let separate = own[i] / none[i] * weathers[i];
            // The path rises by some metres above the ground. Over these a mixture with one scale height thins a little
            // less.
            assert!((both[i] / separate - 1.0).abs() < 1e-2, "{both:?} {weathers:?}");
        }
    }
    // SAFETY: live.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn a_changed_context_draws_like_one_created_with_the_new_values() {
    let device = device();
    let dusty = CString::new(DUSTY).unwrap();
    let (first, second) = (sky(WK_SKY_ISOTROPIC), sky(WK_SKY_DIRECTIONAL));
    {
        let mut scene = Scene::new(device, None, WK_TONE_EXPONENTIAL, &first);
        let mut last = scene.picture();
        // Compares with a context that was created with these values, in a frame with the same number, because dither
        // depends on it.
        let mut check =
            |scene: &mut Scene, (planet, tone, model): (Option<&CString>, _, &wk_sky_settings), what: &str| {
                let mut created = Scene::new(device, planet, tone, model);
                created.frames = scene.frames;
                let (wanted, drawn) = (created.picture(), scene.picture());
                assert!(drawn == wanted, "{what}: another picture than that of a context created so");
                let changed = drawn.iter().zip(&last).filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 1)).count();
                assert!(changed > drawn.len() / 20, "{what}: {changed} pixels have changed");
                last = drawn;
            };
        // SAFETY, for all: live pointers.
        unsafe {
            ok(wk_context_set_tone_curve(scene.context, WK_TONE_LINEAR));
            check(&mut scene, (None, WK_TONE_LINEAR, &first), "tone curve");
            ok(wk_context_set_planet(scene.context, dusty.as_ptr()));
            check(&mut scene, (Some(&dusty), WK_TONE_LINEAR, &first), "planet");
            ok(wk_context_set_sky_settings(scene.context, &second));
            check(&mut scene, (Some(&dusty), WK_TONE_LINEAR, &second), "sky settings");
            // Changes the settings and changes them back between two frames, then sets another planet.
            ok(wk_context_set_sky_settings(scene.context, &first));
            ok(wk_context_set_sky_settings(scene.context, &second));
            ok(wk_context_set_planet(scene.context, null()));
            check(&mut scene, (None, WK_TONE_LINEAR, &second), "back to the Earth");
        }
    }
    // SAFETY: live.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn another_body_is_drawn_in_the_next_frame_and_another_air_fades_in() {
    let device = device();
    let hazier = CString::new(welkin::sky::Planet::earth().with_air_scaled(1.5).to_toml()).unwrap();
    let dusty = CString::new(DUSTY).unwrap();
    {
        // The default tables, which a frame builds by parts.
        let scene = Scene::new(device, None, WK_TONE_EXPONENTIAL, &init("wk_sky_settings"));
        let record = |frame_id| {
            let mut report = init::<wk_report>("wk_report");
            let frame = wk_frame { frame_id, ..init("wk_frame") };
            // SAFETY: live pointers.
            unsafe {
                ok(wk_view_record(scene.view, &frame, WK_STAGE_PREPARE));
                ok(wk_view_get_report(scene.view, &mut report));
            }
            report.tables_rebuilt
        };
        assert_eq!(record(1), 2, "a draft, and the observer's tables");
        // SAFETY: live pointers.
        unsafe { ok(wk_context_set_planet(scene.context, hazier.as_ptr())) };
        assert_eq!(record(2), 1, "a part of a draft that fades in later");
        // SAFETY: live pointers.
        unsafe { ok(wk_context_set_planet(scene.context, dusty.as_ptr())) };
        assert_eq!(record(3), 2, "a draft, and the observer's tables");
    }
    // SAFETY: live.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn what_cannot_be_set_is_named_and_changes_nothing() {
    let world = World::new();
    let hash = || {
        let mut hash = 0;
        // SAFETY: live pointers.
        ok(unsafe { wk_context_state_hash(world.context, &mut hash) });
        hash
    };
    let before = hash();
    let broken = [
        (DUSTY.replacen("asymmetry_g = 0.68", "asymmetry_g = 2.0", 1), WK_ERROR_INVALID_ARGUMENT, "mie.asymmetry_g"),
        (DUSTY.replacen("[0.30, ", "[1.30, ", 1), WK_ERROR_INVALID_ARGUMENT, "ground_albedo"),
        (DUSTY.replacen("[rayleigh]", "[rayleigh", 1), WK_ERROR_PARSE, "planet_toml: planet file, line 10"),
    ];
    for (text, status, name) in broken {
        let text = CString::new(text).unwrap();
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_context_set_planet(world.context, text.as_ptr()) }, status, "{name}");
        assert!(message().contains(name), "{}", message());
    }
    // SAFETY, here and below: live pointers.
    assert_eq!(unsafe { wk_context_set_tone_curve(world.context, 3) }, WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("curve must be"), "{}", message());
    let settings = wk_sky_settings { orders: 99, ..init("wk_sky_settings") };
    assert_eq!(unsafe { wk_context_set_sky_settings(world.context, &settings) }, WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("settings.orders must be"), "{}", message());
    assert_eq!(hash(), before);
}

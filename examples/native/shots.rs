//! The pictures of the gallery: where, when and in what weather.

use glam::{DMat3, DVec3, Vec3};
use welkin::{
    context::{Context, GivenDirection},
    frame::Exposure,
    glass::{Pane, Windscreen, WiperArm},
    rain::{AreaRain, AreaShape, Planes, RainArea, Shelter},
    scene::HostLight,
    weather::{
        Aerosol, AerosolKind, CloudKind, CloudLayer, Fog, FogKind, Lofted, LoftedKind, Precipitation,
        PrecipitationKind, Surface, SurfaceState, Weather, Wind,
    },
};

use crate::world;

pub struct Shot {
    pub name: &'static str,
    pub caption: &'static str,
    /// Camera over the terrain, m east and north of its centre.
    pub at: [f32; 2],
    /// Above the ground, or above the sea where there is no terrain in the picture.
    pub height_m: f64,
    pub above_ground: bool,
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
    pub fov_y_deg: f64,
    /// Sets sun and weather; the second argument is the ground's altitude below the camera, m.
    pub weather: fn(&mut Context, f64) -> welkin::Result<()>,
    /// Whether there is a bridge over the road.
    pub bridge: bool,
    /// The window that the camera looks through at a time, s.
    pub windscreen: Option<fn(f64) -> Windscreen>,
}

/// A cab's upright window, 0.25 m away, met by rain at 12 m/s.
fn cab(arms: [Option<WiperArm>; 2]) -> Windscreen {
    Windscreen { pane: Pane::WholeView(0.25), velocity_m_s: DVec3::new(0.0, 0.0, -12.0), arms, ..Windscreen::default() }
}

/// A wiper `along` the lower edge that goes to and fro in 1.5 s.
fn wiper(along_m: f64, time_s: f64) -> WiperArm {
    WiperArm {
        pivot_m: [along_m, -0.02],
        length_m: 0.2,
        inner_radius_m: 0.05,
        parked_deg: 15.0,
        far_deg: 165.0,
        position: 0.5 - 0.5 * (time_s * std::f64::consts::TAU / 1.5).cos(),
        ..WiperArm::default()
    }
}

fn steady_rain(context: &mut Context, ground: f64) -> welkin::Result<()> {
    rain(context, ground, 6.0)
}

fn heavy_rain(context: &mut Context, ground: f64) -> welkin::Result<()> {
    rain(context, ground, 25.0)
}

fn rain(context: &mut Context, ground: f64, rate_mm_h: f64) -> welkin::Result<()> {
    sun(context, 70.0, 35.0)?;
    let weather = Weather {
        visibility_m: 4000.0,
        relative_humidity: 0.95,
        station_altitude_m: ground,
        clouds: vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, 400.0)],
        precipitation: Precipitation::of(PrecipitationKind::Rain, rate_mm_h),
        ..Weather::default()
    };
    context.set_weather(&weather, 0.0, 0.0)
}

fn sun(context: &mut Context, azimuth_deg: f64, elevation_deg: f64) -> welkin::Result<()> {
    context.set_sun(Some(GivenDirection { azimuth_deg, elevation_deg }))
}

const GROUND: Shot = Shot {
    name: "",
    caption: "",
    at: [-2500.0, -6000.0],
    height_m: 2.5,
    above_ground: true,
    azimuth_deg: 8.0,
    elevation_deg: 4.0,
    fov_y_deg: 50.0,
    weather: |_, _| Ok(()),
    bridge: false,
    windscreen: None,
};

/// On the valley's level floor.
const FLOOR: Shot = Shot { at: [2604.0, 138.8], height_m: 1.8, ..GROUND };

pub fn shots() -> Vec<Shot> {
    vec![
        Shot { name: "noon", caption: "Noon, clear", weather: |c, _| sun(c, 160.0, 55.0), ..GROUND },
        Shot { name: "low_sun", caption: "Low sun", weather: |c, _| sun(c, 40.0, 10.0), ..GROUND },
        Shot { name: "sunset", caption: "Sunset", weather: |c, _| sun(c, 15.0, 0.5), ..GROUND },
        Shot { name: "twilight", caption: "Civil twilight", weather: |c, _| sun(c, 15.0, -5.0), ..GROUND },
        Shot {
            name: "night",
            caption: "Night with a gibbous moon",
            elevation_deg: 12.0,
            weather: |c, _| {
                sun(c, 300.0, -35.0)?;
                c.set_moon(Some(GivenDirection { azimuth_deg: 15.0, elevation_deg: 18.0 }))
            },
            ..GROUND
        },
        Shot {
            name: "haze",
            caption: "Haze, visibility 5 km",
            weather: |c, _| {
                sun(c, 70.0, 30.0)?;
                let aerosol = Aerosol::of(AerosolKind::Haze);
                c.set_weather(&Weather { visibility_m: 5000.0, aerosol, ..Weather::default() }, 0.0, 0.0)
            },
            ..GROUND
        },
        Shot {
            name: "overcast",
            caption: "Overcast, light rain, visibility 4 km",
            weather: |c, ground| {
                sun(c, 70.0, 35.0)?;
                let weather = Weather {
                    visibility_m: 4000.0,
                    relative_humidity: 0.95,
                    station_altitude_m: ground,
                    clouds: vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, 400.0)],
                    precipitation: Precipitation::of(PrecipitationKind::Rain, 2.0),
                    ..Weather::default()
                };
                c.set_weather(&weather, 0.0, 0.0)
            },
            ..GROUND
        },
        Shot {
            name: "hail",
            caption: "Hail, 40 mm/h",
            elevation_deg: -8.0,
            weather: |c, ground| {
                sun(c, 70.0, 40.0)?;
                let weather = Weather {
                    visibility_m: 9000.0,
                    relative_humidity: 0.9,
                    station_altitude_m: ground,
                    clouds: vec![CloudLayer::of(CloudKind::Cumulonimbus, 1.0, 900.0)],
                    precipitation: Precipitation::of(PrecipitationKind::Hail, 40.0),
                    wind: Wind::of(5.0, 260.0),
                    ..Weather::default()
                };
                c.set_weather(&weather, 0.0, 0.0)
            },
            ..FLOOR
        },
        Shot {
            name: "blowing_sand",
            caption: "Blowing sand, visibility 500 m",
            elevation_deg: -2.0,
            weather: |c, ground| {
                sun(c, 235.0, 40.0)?;
                let weather = Weather {
                    visibility_m: 500.0,
                    relative_humidity: 0.15,
                    temperature_c: 36.0,
                    station_altitude_m: ground,
                    lofted: Lofted::of(LoftedKind::BlowingSand),
                    wind: Wind::of(19.0, 250.0),
                    ..Weather::default()
                };
                c.set_weather(&weather, 0.0, 0.0)
            },
            ..FLOOR
        },
        Shot {
            name: "wet_road",
            caption: "Wet road after a shower, low sun",
            elevation_deg: -6.0,
            weather: |c, ground| {
                sun(c, 14.0, 9.0)?;
                let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
                let wind = Wind::of(2.0, 250.0);
                c.set_weather(&Weather { surface, wind, station_altitude_m: ground, ..Weather::default() }, 0.0, 0.0)
            },
            ..FLOOR
        },
        Shot {
            name: "drizzle",
            caption: "Drizzle, 0.5 mm/h, visibility 3 km",
            elevation_deg: -3.0,
            weather: |c, ground| {
                sun(c, 70.0, 35.0)?;
                let weather = Weather {
                    visibility_m: 3000.0,
                    relative_humidity: 0.98,
                    fog: Fog::of(FogKind::Mist),
                    station_altitude_m: ground,
                    clouds: vec![CloudLayer::of(CloudKind::Stratus, 1.0, 250.0)],
                    precipitation: Precipitation::of(PrecipitationKind::Drizzle, 0.5),
                    wind: Wind::of(2.0, 260.0),
                    ..Weather::default()
                };
                c.set_weather(&weather, 0.0, 0.0)
            },
            ..FLOOR
        },
        Shot {
            name: "steady_rain",
            caption: "Steady rain, 6 mm/h",
            elevation_deg: -5.0,
            weather: steady_rain,
            ..FLOOR
        },
        Shot {
            name: "under_the_bridge",
            caption: "Dry under the bridge, its windward edge wet",
            elevation_deg: -3.0,
            azimuth_deg: 24.0,
            bridge: true,
            weather: |c, ground| {
                sun(c, 70.0, 35.0)?;
                let weather = Weather {
                    visibility_m: 4000.0,
                    relative_humidity: 0.95,
                    station_altitude_m: ground,
                    clouds: vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, 400.0)],
                    precipitation: Precipitation::of(PrecipitationKind::Rain, 20.0),
                    wind: Wind::of(3.0, 98.0),
                    ..Weather::default()
                };
                c.set_weather(&weather, 0.0, 0.0)?;
                let foot = DVec3::new(f64::from(FLOOR.at[0]), f64::from(FLOOR.at[1]), ground);
                let shelter = |(at, size): &(Vec3, Vec3)| Shelter {
                    center_m: foot + at.as_dvec3() + DVec3::Z * (0.5 * f64::from(size.z)),
                    axes: DMat3::IDENTITY,
                    half_size_m: 0.5 * size.as_dvec3(),
                    velocity_m_s: DVec3::ZERO,
                    planes: Planes::NONE,
                };
                c.set_shelters(&world::bridge().iter().map(shelter).collect::<Vec<_>>())
            },
            ..FLOOR
        },
        Shot {
            name: "cloudburst",
            caption: "Cloudburst, 60 mm/h, gale",
            weather: |c, ground| {
                sun(c, 70.0, 35.0)?;
                let mut weather = Weather {
                    visibility_m: 500.0,
                    relative_humidity: 0.97,
                    station_altitude_m: ground,
                    clouds: vec![CloudLayer::of(CloudKind::Cumulonimbus, 1.0, 600.0)],
                    precipitation: Precipitation::of(PrecipitationKind::Rain, 60.0),
                    ..Weather::default()
                };
                (weather.wind.speed_m_s, weather.wind.from_deg) = (9.0, 280.0);
                c.set_weather(&weather, 0.0, 0.0)
            },
            elevation_deg: -12.0,
            ..FLOOR
        },
        Shot {
            name: "rain_shaft",
            caption: "A shower 5 km away",
            weather: |c, ground| {
                sun(c, 250.0, 14.0)?;
                let weather = Weather {
                    visibility_m: 35_000.0,
                    station_altitude_m: ground,
                    clouds: vec![CloudLayer::of(CloudKind::Stratocumulus, 0.88, 3000.0)],
                    wind: Wind::of(13.0, 275.0),
                    ..Weather::default()
                };
                c.set_weather(&weather, 0.0, 0.0)?;
                let area = |ahead_m: f64, right_m: f64, semi: [f64; 2], rate_mm_h: f64| RainArea {
                    center_m: [f64::from(GROUND.at[0]) + right_m, f64::from(GROUND.at[1]) + ahead_m, ground],
                    shape: AreaShape::Ellipse(semi),
                    heading_deg: 15.0,
                    rim_m: 0.5 * semi[0].min(semi[1]),
                    rate_mm_h,
                    kind: AreaRain::Showers,
                    top_m: ground + 3000.0,
                    ..RainArea::default()
                };
                c.set_rain_areas(&[
                    area(7400.0, -1500.0, [500.0, 500.0], 12.0),
                    area(6300.0, 700.0, [1500.0, 1200.0], 3.0),
                    area(5900.0, 500.0, [800.0, 700.0], 20.0),
                ])
            },
            height_m: 130.0,
            azimuth_deg: 10.0,
            elevation_deg: 5.0,
            fov_y_deg: 30.0,
            ..GROUND
        },
        Shot {
            name: "work_lights",
            caption: "Rain at night in work lights",
            weather: |c, ground| {
                sun(c, 300.0, -35.0)?;
                c.set_exposure(Exposure::Ev100(4.5))?;
                let weather = Weather {
                    visibility_m: 4000.0,
                    station_altitude_m: ground,
                    precipitation: Precipitation::of(PrecipitationKind::Rain, 8.0),
                    ..Weather::default()
                };
                let lamp = |x: f64, to: [f64; 3]| HostLight {
                    position_m: DVec3::new(f64::from(GROUND.at[0]) + x, f64::from(GROUND.at[1]) + 1.0, ground + 4.5),
                    direction: DVec3::from(to),
                    intensity_cd: [40_000.0, 37_000.0, 30_000.0],
                    inner_deg: 8.0,
                    outer_deg: 24.0,
                };
                c.set_lights(&[lamp(-1.2, [-0.2, 1.0, -0.2]), lamp(1.2, [0.35, 1.0, -0.25])])?;
                c.set_weather(&weather, 0.0, 0.0)
            },
            elevation_deg: -9.0,
            ..GROUND
        },
        Shot {
            name: "windscreen",
            caption: "Through the windscreen, heavy rain",
            weather: heavy_rain,
            windscreen: Some(|_| cab([None; 2])),
            ..GROUND
        },
        Shot {
            name: "wiped",
            caption: "The same with two wipers going",
            weather: heavy_rain,
            windscreen: Some(|time_s| cab([0.1, 0.32].map(|along_m| Some(wiper(along_m, time_s))))),
            ..GROUND
        },
        Shot {
            name: "fog",
            caption: "Fog, visibility 150 m",
            weather: |c, ground| {
                sun(c, 60.0, 20.0)?;
                c.set_weather(
                    &Weather {
                        visibility_m: 150.0,
                        station_altitude_m: ground - 60.0,
                        fog: Fog::of(FogKind::Fog),
                        ..Weather::default()
                    },
                    0.0,
                    0.0,
                )
            },
            ..GROUND
        },
        Shot {
            name: "shallow_fog",
            caption: "Shallow fog",
            weather: |c, ground| {
                sun(c, 60.0, 8.0)?;
                let fog = Fog { top_m: Some(30.0), visibility_inside_m: Some(150.0), ..Fog::of(FogKind::Shallow) };
                c.set_weather(&Weather { fog, station_altitude_m: ground - 60.0, ..Weather::default() }, 0.0, 0.0)
            },
            height_m: 12.0,
            ..GROUND
        },
        Shot {
            name: "twelve_km",
            caption: "12 km up",
            height_m: 12e3,
            above_ground: false,
            elevation_deg: -2.0,
            weather: |c, _| sun(c, 60.0, 25.0),
            ..GROUND
        },
        Shot {
            name: "space",
            caption: "200 km up: the limb",
            height_m: 200e3,
            above_ground: false,
            elevation_deg: -14.0,
            weather: |c, _| sun(c, 30.0, 5.0),
            ..GROUND
        },
        Shot {
            name: "shadow",
            caption: "200 km up at the terminator: the Earth's shadow",
            height_m: 200e3,
            above_ground: false,
            elevation_deg: -16.0,
            azimuth_deg: 60.0,
            fov_y_deg: 60.0,
            weather: |c, _| sun(c, 10.0, -9.0),
            ..GROUND
        },
    ]
}

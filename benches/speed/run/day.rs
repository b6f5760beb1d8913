//! Script of the day: reports that arrive one after the other, the times of the frames, and the movement of camera and
//! sun.

use glam::{DVec2, DVec3};
use welkin::{context::GivenDirection, scene::Camera};

/// Ticks per second of simulation time. Around a change of weather each tick has a frame, elsewhere each sixth.
pub const TICKS_PER_S: u32 = 60;
const TICKS_PER_SLOW_FRAME: u32 = 6;

/// Elevation of the sun at the start, degrees, and its change per second at its own pace.
const SUN_DEG: f64 = 15.0;
const SUN_DEG_PER_S: f64 = -0.0029;

/// Time from one report to the next, with one weather, and the movement during that time.
pub struct Segment {
    pub name: &'static str,
    pub report: &'static str,
    /// Speed of the camera, m/s, its turning rate, degrees per second, and its rate of climb, m/s.
    speed_m_s: f64,
    turn_deg_s: f64,
    climb_m_s: f64,
    /// Whether the sun moves at 60 times its pace.
    has_fast_sun: bool,
}

const STANDS: Segment =
    Segment { name: "", report: "", speed_m_s: 0.0, turn_deg_s: 0.0, climb_m_s: 0.0, has_fast_sun: false };
const DRIVES: Segment = Segment { speed_m_s: 15.0, ..STANDS };
const DRIVES_AND_TURNS: Segment = Segment { turn_deg_s: 6.0, ..DRIVES };

pub const SEGMENTS: [Segment; 13] = [
    Segment { name: "clear", report: "LOWI 210820Z 24008KT 9999 SKC 18/09 Q1015", ..STANDS },
    Segment { name: "haze", report: "LOWI 210850Z 24008KT 5000 HZ SKC 18/10 Q1015", ..STANDS },
    Segment { name: "few clouds", report: "LOWI 210920Z 24008KT 9999 FEW030 18/11 Q1014", ..DRIVES_AND_TURNS },
    Segment { name: "light rain", report: "LOWI 210950Z 25010KT 9999 -RA BKN030 15/12 Q1012", ..STANDS },
    Segment { name: "rain", report: "LOWI 211020Z 26012KT 4000 RA OVC020 13/12 Q1010", ..DRIVES },
    Segment {
        name: "rain ends",
        report: "LOWI 211050Z 27008KT 9999 SCT035 14/11 Q1011",
        climb_m_s: 3.0,
        ..DRIVES_AND_TURNS
    },
    Segment { name: "mist", report: "LOWI 211120Z 22003KT 2000 BR OVC010 11/10 Q1012", turn_deg_s: 10.0, ..STANDS },
    Segment { name: "fog", report: "LOWI 211150Z 00000KT 0400 FG VV002 09/09 Q1013", ..DRIVES },
    Segment {
        name: "snow begins",
        report: "LOWI 211220Z 32010KT 3000 -SN BKN020 M01/M02 Q1014",
        turn_deg_s: 10.0,
        has_fast_sun: true,
        ..STANDS
    },
    Segment {
        name: "snow ends",
        report: "LOWI 211250Z 32008KT 9999 FEW040 M02/M06 Q1016",
        has_fast_sun: true,
        ..DRIVES_AND_TURNS
    },
    Segment {
        name: "sunset",
        report: "LOWI 211320Z 32004KT CAVOK M03/M08 Q1018",
        climb_m_s: 3.0,
        has_fast_sun: true,
        ..STANDS
    },
    Segment { name: "dusk", report: "LOWI 211350Z 00000KT 9999 FEW040 M04/M08 Q1018", has_fast_sun: true, ..STANDS },
    Segment {
        name: "night",
        report: "LOWI 211420Z 00000KT 9999 SKC M05/M08 Q1019",
        has_fast_sun: true,
        ..DRIVES_AND_TURNS
    },
];

/// Durations of the parts of a day, in ticks, and the number of frames at rest.
#[derive(Clone, Copy)]
pub struct Pace {
    pub name: &'static str,
    pub segment: u32,
    /// Ticks with a frame each, before and after a report arrives.
    before: u32,
    after: u32,
    /// Duration of a change of weather.
    pub transition: u32,
    /// Frames of each weather at rest.
    pub rest_frames: u32,
    /// Factor on the sun's pace while it moves fast.
    fast_sun: f64,
}

/// The whole day: 6,000 frames.
const FULL: Pace = Pace {
    name: "full",
    segment: 30 * TICKS_PER_S,
    before: TICKS_PER_S / 2,
    after: 3 * TICKS_PER_S,
    transition: 10 * TICKS_PER_S,
    rest_frames: 500,
    fast_sun: 60.0,
};

/// Day at five times the pace: 1,680 frames.
const QUICK: Pace = Pace {
    name: "quick",
    segment: 6 * TICKS_PER_S,
    before: TICKS_PER_S / 2,
    after: TICKS_PER_S,
    transition: 2 * TICKS_PER_S,
    rest_frames: 60,
    fast_sun: 300.0,
};

/// Time after the end of a change from which its weather counts as settled, s.
pub const SETTLES_S: u32 = 2;

impl Pace {
    /// Returns the pace that the environment asks for: `RUN_QUICK=1` for the quick one.
    pub fn asked() -> Self {
        if std::env::var_os("RUN_QUICK").is_some() { QUICK } else { FULL }
    }

    /// Returns the ticks of all frames, in order.
    pub fn ticks(&self) -> Vec<u32> {
        let (mut tick, mut all) = (0, Vec::new());
        while tick < self.segment * SEGMENTS.len() as u32 {
            all.push(tick);
            let since = tick % self.segment;
            let is_near = since < self.after && tick >= self.segment || since >= self.segment - self.before;
            let is_last = tick >= self.segment * (SEGMENTS.len() as u32 - 1);
            let is_fast = is_near && !(is_last && since >= self.after);
            tick += if is_fast { 1 } else { TICKS_PER_SLOW_FRAME };
        }
        all
    }

    /// Whether a tick lies after its segment's change and the time in which its weather settles.
    pub fn is_settled(&self, tick: u32) -> bool {
        tick < self.segment || tick % self.segment >= self.transition + SETTLES_S * TICKS_PER_S
    }
}

/// Camera and sun of the day at one tick.
#[derive(Clone, Copy)]
pub struct Rig {
    tick: u32,
    eye: DVec3,
    heading_rad: f64,
    sun_deg: f64,
}

impl Rig {
    /// Returns the state at the start of the day.
    pub fn new() -> Self {
        Self { tick: 0, eye: DVec3::new(0.0, 0.0, 2.0), heading_rad: 0.0, sun_deg: SUN_DEG }
    }

    /// Advances to a later tick.
    pub fn advance(&mut self, pace: &Pace, tick: u32) {
        while self.tick < tick {
            let segment = &SEGMENTS[(self.tick / pace.segment) as usize];
            let step_s = 1.0 / f64::from(TICKS_PER_S);
            self.heading_rad += segment.turn_deg_s.to_radians() * step_s;
            self.eye += self.velocity_m_s(pace) * step_s;
            self.sun_deg += SUN_DEG_PER_S * step_s * if segment.has_fast_sun { pace.fast_sun } else { 1.0 };
            self.tick += 1;
        }
    }

    /// Returns the velocity of the camera, m/s.
    pub fn velocity_m_s(&self, pace: &Pace) -> DVec3 {
        let segment = &SEGMENTS[(self.tick / pace.segment) as usize];
        (segment.speed_m_s * self.ahead()).extend(segment.climb_m_s)
    }

    fn ahead(&self) -> DVec2 {
        DVec2::new(self.heading_rad.sin(), self.heading_rad.cos())
    }

    /// Returns the camera, which looks level ahead.
    pub fn camera(&self) -> Camera {
        Camera::look_to(self.eye, self.ahead().extend(0.0), DVec3::Z, 0.9, 16.0 / 9.0, 0.1)
    }

    /// Returns the direction of the sun.
    pub fn sun(&self) -> GivenDirection {
        GivenDirection { azimuth_deg: 240.0, elevation_deg: self.sun_deg }
    }

    /// Returns the direction of the moon, which stays.
    pub fn moon() -> GivenDirection {
        GivenDirection { azimuth_deg: 120.0, elevation_deg: 35.0 }
    }
}

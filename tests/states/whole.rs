//! A saved state is complete: whatever the host has changed since the last step, the context that saves it, a context
//! that loads its own state, and a new one that loads it have the same hash, save the same bytes, and continue alike.

use std::{
    sync::{Arc, OnceLock},
    time::Duration,
};

use welkin::{
    Status,
    chance::RandomStream,
    context::{Context, ContextDesc},
    frame::Shared,
    gpu::{Device, DeviceOptions},
    ground::GroundModel,
    snowpack::LyingSnowModel,
};
use welkin_support::accept;

use crate::inputs::{INPUTS, Input, Tiles, roof, snowfall};

/// A device that draws nothing, shared by all contexts of the tests.
fn device() -> &'static (Arc<Device>, Arc<Shared>) {
    static DEVICE: OnceLock<(Arc<Device>, Arc<Shared>)> = OnceLock::new();
    DEVICE.get_or_init(|| {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let device = Device::headless(&options).unwrap();
        let shared = Arc::new(Shared::new(&device).unwrap());
        (device, shared)
    })
}

pub fn context_of(desc: ContextDesc) -> Context {
    let (device, shared) = device();
    Context::new(device.clone(), shared.clone(), desc).unwrap()
}

/// Creates a context with simulated ground and snow.
pub fn context() -> Context {
    context_of(ContextDesc {
        lying_snow: LyingSnowModel::Simulated,
        ground: GroundModel::Simulated,
        seed: 7,
        ..ContextDesc::default()
    })
}

/// Three contexts with the same inputs, and the host's tiles.
struct Three {
    /// Never loads a state.
    kept: Context,
    /// Loads its own saved states.
    loaded: Context,
    /// Replaced by a new one that loads the state.
    anew: Context,
    tiles: Tiles,
    log: Vec<String>,
}

impl Three {
    fn new(first: &[&str]) -> Self {
        let [kept, loaded, anew] = [context(), context(), context()];
        let mut three = Self { kept, loaded, anew, tiles: Tiles::default(), log: Vec::new() };
        three.each(|c| {
            c.set_weather(&snowfall(3), 0.0, 0.0).unwrap();
            c.set_shelters(&[roof(1)]).unwrap();
        });
        first.iter().for_each(|name| three.tell(input(name), 4));
        three.update(125.0);
        three
    }

    fn each(&mut self, act: impl Fn(&mut Context)) {
        [&mut self.kept, &mut self.loaded, &mut self.anew].into_iter().for_each(act);
    }

    fn tell(&mut self, (name, act): &Input, n: u32) {
        self.log.push(format!("{name} {n}"));
        let before = self.tiles.clone();
        for context in [&mut self.kept, &mut self.loaded, &mut self.anew] {
            self.tiles = before.clone();
            act(context, &mut self.tiles, n);
        }
    }

    fn update(&mut self, seconds: f64) {
        self.log.push(format!("{seconds} s"));
        self.each(|c| c.update(c.time_s() + seconds).unwrap());
        self.compare();
    }

    /// Fails unless all three have the same state.
    fn compare(&self) {
        let of = |c: &Context| (String::from_utf8(c.save().unwrap()).unwrap(), c.state_hash().unwrap());
        let (kept, hash) = of(&self.kept);
        for (which, other) in [("itself", &self.loaded), ("another", &self.anew)] {
            let (state, other_hash) = of(other);
            let differs = kept.lines().zip(state.lines()).skip(1).find(|(a, b)| a != b);
            let short = |line: &str| line.chars().take(300).collect::<String>();
            let lines = differs.map(|(a, b)| format!("{}\n{}", short(a), short(b)));
            let log = self.log.join(", ");
            assert!(kept == state, "{which} differs after {log}:\n{}", lines.unwrap_or_default());
            assert_eq!(hash, other_hash, "{which} has another hash after {log}");
        }
    }

    /// Saves the first, and loads that state into the second and into a new one.
    fn load(&mut self) {
        let state = self.kept.save().unwrap();
        assert_eq!(state, self.loaded.save().unwrap());
        self.loaded.load(&state).unwrap();
        self.anew = context();
        self.tiles.set_on(&mut self.anew);
        self.anew.load(&state).unwrap();
        self.log.push("load".into());
        self.compare();
    }
}

fn input(name: &str) -> &'static Input {
    INPUTS.iter().find(|i| i.0 == name).unwrap()
}

/// Sets of inputs before the tested one: the grounds on which it is tested.
const GROUNDS: [&[&str]; 5] = [
    &["grid", "a wind field"],
    &["terrain with tiles", "a wind field"],
    &["terrain with tiles"],
    &["terrain with tiles", "soil", "a bucket"],
    &[],
];

/// Pairs of ground and input: all in the long suite, else each input on one ground, in turn.
fn pairs() -> impl Iterator<Item = (&'static [&'static str], &'static Input)> {
    let is_long = accept();
    INPUTS.iter().enumerate().flat_map(move |(i, input)| {
        let on = move |(j, _): &(usize, &[&str])| is_long || i % GROUNDS.len() == *j;
        GROUNDS.into_iter().enumerate().filter(on).map(move |(_, ground)| (ground, input))
    })
}

#[test]
fn every_input_between_steps_is_in_the_saved_state() {
    for (ground, input) in pairs() {
        let mut three = Three::new(ground);
        three.tell(input, if ground.len() == 2 { 4 } else { 7 });
        three.load();
        for seconds in [0.0, 0.4, 70.0] {
            three.update(seconds);
        }
    }
}

#[test]
fn any_sequence_of_changes_saves_and_steps_goes_on_alike() {
    for seed in 1..=6 {
        let mut chance = RandomStream::new(seed, 1);
        let mut pick = |below: u32| (chance.even() * f64::from(below)) as u32;
        let mut three = Three::new(GROUNDS[seed as usize % GROUNDS.len()]);
        for _ in 0..40 {
            for _ in 0..pick(3) {
                three.tell(&INPUTS[pick(INPUTS.len() as u32) as usize], pick(1000));
            }
            if pick(2) == 0 {
                three.load();
            }
            three.update([0.0, 0.3, 2.1, 13.0, 61.0, 200.0][pick(6) as usize]);
        }
    }
}

#[test]
fn settings_while_steps_remain_wait_for_them_and_are_in_the_state_after_them() {
    for (ground, input) in pairs() {
        // Refused while steps remain.
        if ["ploughing", "pressing", "soil", "a bucket", "sand by the truck", "no soil"].contains(&input.0) {
            continue;
        }
        let mut three = Three::new(ground);
        three.log.push(format!("{} while steps remain", input.0));
        let end_s = three.kept.time_s() + 300.0;
        let before = three.tiles.clone();
        // This context takes all steps in one update, then the change.
        three.kept.update(end_s).unwrap();
        (input.1)(&mut three.kept, &mut three.tiles, 4);
        // These contexts get the change in the middle of the steps.
        for context in [&mut three.loaded, &mut three.anew] {
            let first = context.update_within(end_s, Duration::ZERO).unwrap();
            three.tiles = before.clone();
            (input.1)(context, &mut three.tiles, 4);
            let mut led = first;
            while led == Status::Pending {
                led = context.update_within(end_s, Duration::ZERO).unwrap();
            }
        }
        three.compare();
        three.load();
        three.update(70.0);
    }
}

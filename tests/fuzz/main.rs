//! Random sequences of calls over the whole C interface, on the backend that needs no GPU: no crash, no internal error,
//! no error without a name that a host knows, no result that is not a number.
//!
//! Seeded: `WELKIN_FUZZ_SEED=N` plays sequence N again and prints its calls.

mod corpora;
mod height_files;
mod noise_files;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
    time::{Duration, Instant},
};

use welkin::capi::{abi, status::WK_ERROR_DEVICE_LOST};
use welkin_support::{
    accept,
    fuzz::{
        calls::{Answer, CALLS, ELSEWHERE, World},
        dice::Dice,
        judge::Judge,
    },
    refusals,
};

/// Calls of one sequence.
const LENGTH: usize = 120;

/// Counts of calls and of accepted calls for each function, and the faults found.
#[derive(Default)]
struct Tally {
    answered: BTreeMap<&'static str, [usize; 2]>,
    slowest: BTreeMap<&'static str, (Duration, u64)>,
    faults: BTreeMap<String, String>,
}

impl Tally {
    /// Keeps the fault of an answer, one of each kind: messages that differ only in numbers are the same kind.
    fn note(&mut self, function: &str, seed: u64, step: usize, answer: Answer, judge: &Judge) {
        for fault in answer.faults.into_iter().chain(judge.fault(function, answer.status)) {
            let kind = format!("{function}: {}", fault.replace(|c: char| c.is_ascii_digit() || "+-.".contains(c), ""));
            self.faults.entry(kind).or_insert_with(|| format!("sequence {seed}, call {step}, {function}: {fault}"));
        }
    }

    fn assert_clean(&self) {
        let faults: Vec<_> = self.faults.values().map(String::as_str).collect();
        assert!(faults.is_empty(), "{} kinds of faults:\n{}", faults.len(), faults.join("\n"));
    }
}

/// Plays one sequence.
fn play(seed: u64, judge: &Judge, tally: &mut Tally, aloud: bool) {
    // After a crash this file names the sequence to replay.
    fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz-sequence.txt"), seed.to_string()).expect("writable");
    let mut dice = Dice::new(seed);
    let mut world = World::on_noop();
    for step in 0..LENGTH {
        let (function, call) = dice.pick(CALLS);
        if aloud {
            println!("{step} {function}");
        }
        let start = Instant::now();
        let answer = call(&mut dice, &mut world);
        if aloud {
            let text = if answer.status < 0 { refusals::message() } else { String::new() };
            println!("    {} in {:?} {text}", answer.status, start.elapsed());
        }
        let slowest = tally.slowest.entry(function).or_default();
        *slowest = (*slowest).max((start.elapsed(), seed));
        tally.answered.entry(function).or_default()[usize::from(answer.status >= 0)] += 1;
        tally.note(function, seed, step, answer, judge);
    }
}

#[test]
fn every_function_has_a_line() {
    let covered: BTreeSet<&str> = CALLS.iter().map(|c| c.0).chain(ELSEWHERE.iter().copied()).collect();
    let all: BTreeSet<&str> = abi::functions().iter().copied().filter(|f| !f.ends_with("_init")).collect();
    assert_eq!(all.difference(&covered).collect::<Vec<_>>(), Vec::<&&str>::new(), "functions without a line");
}

#[test]
fn random_calls_are_answered_by_name() {
    let judge = Judge;
    let mut tally = Tally::default();
    let only = std::env::var("WELKIN_FUZZ_SEED").ok().map(|s| s.parse::<u64>().expect("WELKIN_FUZZ_SEED is a number"));
    if let Some(seed) = only {
        play(seed, &judge, &mut tally, true);
    } else {
        let (least, time) = if accept() { (200, Duration::from_secs(60)) } else { (60, Duration::ZERO) };
        let start = Instant::now();
        for seed in 1.. {
            if seed > least && start.elapsed() >= time {
                let mut slowest: Vec<_> = tally.slowest.iter().collect();
                slowest.sort_by_key(|s| std::cmp::Reverse(s.1));
                println!("slowest (duration, sequence): {:?}", &slowest[..8]);
                println!("{} sequences of {LENGTH} calls in {:?}", seed - 1, start.elapsed());
                break;
            }
            play(seed, &judge, &mut tally, false);
        }
        // Every function must be accepted at least once, except those that need a window or a host's own device.
        let never = |f: &&&str| tally.answered.get(**f).is_none_or(|n| n[1] == 0);
        let refused: Vec<_> = CALLS.iter().map(|c| &c.0).filter(never).collect();
        let hosts = [
            "wk_surface_",
            "wk_device_forget_vulkan_image",
            "wk_context_get_ground_texture",
            "wk_context_get_terrain_texture",
            "wk_view_get_cloud_shadows",
            "wk_view_get_environment",
            "wk_view_get_frame_textures",
        ];
        let refused: Vec<_> = refused.into_iter().filter(|f| !hosts.iter().any(|h| f.starts_with(h))).collect();
        assert!(refused.is_empty(), "never accepted: {refused:?}");
    }
    tally.assert_clean();
}

/// Damages one kind of text at a time, many times over, and hands it to the function that reads it.
#[test]
fn damaged_texts_are_read_or_refused_by_name() {
    let judge = Judge;
    let mut tally = Tally::default();
    let many = if accept() { 10 } else { 1 };
    let readers = [
        ("wk_weather_from_metar", 20_000),
        ("wk_context_create", 150),
        ("wk_context_load", 1_000),
        ("wk_view_load_plan", 2_000),
    ];
    let mut dice = Dice::new(1);
    let mut world = World::on_noop();
    let call = |name: &str| CALLS.iter().find(|c| c.0 == name).expect("in the table").1;
    // The texts to damage: a state and a plan that were saved in the middle of a sequence.
    for _ in 0..300 {
        let (function, call) = dice.pick(CALLS);
        if function.starts_with("wk_context_set") || function == "wk_context_update" || function == "wk_view_record" {
            call(&mut dice, &mut world);
        }
    }
    for (reader, times) in readers {
        let mut accepted = 0;
        for i in 0..times * many {
            if i % 50 == 0 {
                call("wk_context_save")(&mut dice, &mut world);
                call("wk_view_save_plan")(&mut dice, &mut world);
            }
            let answer = call(reader)(&mut dice, &mut world);
            accepted += usize::from(answer.status >= 0);
            tally.note(reader, 1, i, answer, &judge);
        }
        println!("{reader}: {accepted} of {} accepted", times * many);
        assert!(accepted > 0 && accepted < times * many, "{reader}: {accepted} of {}", times * many);
    }
    tally.assert_clean();
}

/// On a lost device every call returns, with the device's status or as usual. All objects can be destroyed, and a new
/// device works beside the lost one.
#[test]
fn a_lost_device_is_answered_by_every_call() {
    let judge = Judge;
    for seed in 0..4 {
        let mut dice = Dice::new(seed);
        let mut world = World::on_noop();
        assert_eq!(world.lose(), WK_ERROR_DEVICE_LOST);
        for (function, call) in CALLS.iter().flat_map(|c| std::iter::repeat_n(c, 5)) {
            let answer = call(&mut dice, &mut world);
            let lost = answer.status == WK_ERROR_DEVICE_LOST;
            assert!(answer.faults.is_empty(), "{function}: {:?}", answer.faults);
            let text = refusals::message();
            assert!(!lost || text.contains("destroy it and create a new one"), "{function}: {text}");
            assert!(lost || judge.fault(function, answer.status).is_none(), "{function}: {} {text}", answer.status);
        }
        let mut tally = Tally::default();
        play(seed, &judge, &mut tally, false);
        tally.assert_clean();
    }
}

/// Three threads call at random on the same objects, exclusive ones too, and destroy objects that the others use. Each
/// call returns.
#[test]
fn threads_that_break_the_rules_are_answered() {
    let judge = Judge;
    for round in 0..if accept() { 40 } else { 6 } {
        let mut world = World::on_noop();
        let worlds = std::thread::scope(|scope| {
            let start = |thread: u64| {
                let (mut own, judge) = (world.shared(), &judge);
                scope.spawn(move || {
                    let mut dice = Dice::new(1000 * round + thread);
                    for _ in 0..LENGTH {
                        let (function, call) = dice.pick(CALLS);
                        let answer = call(&mut dice, &mut own);
                        let fault = judge.fault(function, answer.status);
                        assert!(fault.is_none(), "round {round}, {function}: {fault:?}");
                    }
                    own
                })
            };
            let threads: Vec<_> = (0..3).map(start).collect();
            threads.into_iter().map(|t| t.join().expect("no fault")).collect::<Vec<_>>()
        });
        worlds.iter().for_each(|w| world.adopt(w));
    }
}

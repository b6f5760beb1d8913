//! Processor time of the whole process, the measure that other load on the machine affects least.

/// Time that the threads of this process have run, ns.
pub fn processor_ns() -> u64 {
    let threads = std::fs::read_dir("/proc/self/task").expect("a Linux");
    // A thread may end after it was listed, before its file is read.
    let of = |thread: std::fs::DirEntry| std::fs::read_to_string(thread.path().join("schedstat")).ok();
    let ns = |text: String| text.split(' ').next().and_then(|ns| ns.parse::<u64>().ok()).unwrap_or(0);
    threads.flatten().filter_map(of).map(ns).sum()
}

/// The median of numbers.
pub fn median(of: &mut [f64]) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// Attempts at a measurement before it is judged.
const ATTEMPTS: u32 = 4;
/// Processors that other programs may take while a measurement still counts.
const QUIET: f64 = 0.15;

/// Held while something is measured.
static ALONE: std::sync::Mutex<()> = std::sync::Mutex::new(());

/// Measures until each ratio is at most its bound, four times at most. Other work on the machine only makes ratios of
/// processor time larger: it takes caches and the other half of a core. A measurement therefore fails only on a machine
/// that was quiet during at least one attempt; otherwise a line says that nothing was judged.
///
/// # Panics
/// If a quiet attempt exceeded a bound, and no attempt kept them all.
pub fn holds(name: &str, most: &[f64], mut measure: impl FnMut() -> Vec<f64>) {
    // Tests of one binary may run beside each other.
    let _alone = ALONE.lock();
    let (mut quiet, mut least_load) = (None, f64::INFINITY);
    for _ in 0..ATTEMPTS {
        let load = OtherLoad::begin();
        let ratios = measure();
        let taken = load.processors();
        assert_eq!(ratios.len(), most.len(), "{name}");
        println!("{name}: {ratios:.3?}, at most {most:?}; others took {taken:.2} processors");
        if ratios.iter().zip(most).all(|(ratio, most)| ratio <= most) {
            return;
        }
        least_load = least_load.min(taken);
        if taken <= QUIET {
            quiet = Some(ratios);
        }
    }
    assert!(quiet.is_none(), "{name}: {quiet:?}, at most {most:?}");
    println!("{name}: not judged, other programs took {least_load:.2} processors and more");
}

/// Counts the processor time of other programs.
struct OtherLoad {
    begun: std::time::Instant,
    others_ticks: f64,
}

impl OtherLoad {
    fn begin() -> Self {
        Self { begun: std::time::Instant::now(), others_ticks: others_ticks() }
    }

    /// Mean number of processors that other programs used since the value was made.
    fn processors(&self) -> f64 {
        (others_ticks() - self.others_ticks) / TICKS_PER_S / self.begun.elapsed().as_secs_f64()
    }
}

/// Unit of times in /proc: USER_HZ, which is 100 on every Linux.
const TICKS_PER_S: f64 = 100.0;

/// Processor time of all programs but this one since the machine started, ticks.
fn others_ticks() -> f64 {
    let read = |path| std::fs::read_to_string(path).expect("a Linux");
    let numbers = |text: &str| text.split_whitespace().map(|n| n.parse().unwrap_or(0.0)).collect::<Vec<f64>>();
    // user, nice, system, (idle, iowait,) irq, softirq, steal
    let all = numbers(read("/proc/stat").lines().next().unwrap_or_default());
    let busy: f64 = [1, 2, 3, 6, 7, 8].iter().filter_map(|i| all.get(*i)).sum();
    // The name of the program, in parentheses, may have spaces. User and system time are fields 14 and 15.
    let own = read("/proc/self/stat");
    let own = numbers(own.rsplit(')').next().unwrap_or_default());
    busy - own.get(11).unwrap_or(&0.0) - own.get(12).unwrap_or(&0.0)
}

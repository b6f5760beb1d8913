//! Processor time of the whole process, which other load on the machine affects least.

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

//! What work takes, in processor time of the whole process: what else the machine does falls on it least.

/// Seconds that all threads of the process have run so far.
pub fn processor_s() -> f64 {
    let tasks = std::fs::read_dir("/proc/self/task").expect("a Linux");
    let of = |task: std::fs::DirEntry| std::fs::read_to_string(task.path().join("schedstat")).ok();
    let ns = |text: String| text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0);
    tasks.flatten().filter_map(of).map(ns).sum::<f64>() * 1e-9
}

pub fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

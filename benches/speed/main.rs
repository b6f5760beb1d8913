//! Benchmarks that print ratios measured within one run: `make bench`; `cargo bench -- record` runs the named ones only
//! (record, fog, sky).

mod fog;
mod record;
mod sky;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let named: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let wanted = |name: &str| named.is_empty() || named.iter().any(|n| n == name);
    if wanted("record") {
        record::run()?;
    }
    if wanted("fog") {
        fog::run()?;
    }
    if wanted("sky") {
        sky::run()?;
    }
    Ok(())
}

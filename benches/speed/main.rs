//! Benchmarks that print ratios measured within one run: `make bench`. `cargo bench -- record` runs only the named ones
//! (banks, clouds, copies, falling, record, environment, first, fog, glass, gpu, ground, land, noise, parts, radiance,
//! rain, run, sea, sky, wind).

mod banks;
mod clouds;
mod copies;
mod copying;
mod environment;
mod falling;
mod first;
mod fog;
mod glass;
mod gpu;
mod ground;
mod host_images;
mod land;
mod noise;
mod parts;
mod radiance;
mod rain;
mod record;
mod run;
mod sea;
mod sky;
mod wind;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let named: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let wanted = |name: &str| named.is_empty() || named.iter().any(|n| n == name);
    if wanted("copies") {
        copies::run()?;
    }
    if wanted("banks") {
        banks::run()?;
    }
    if wanted("clouds") {
        clouds::run()?;
    }
    if wanted("falling") {
        falling::run()?;
    }
    if wanted("record") {
        record::run()?;
    }
    if wanted("environment") {
        environment::run()?;
    }
    if wanted("first") {
        first::run()?;
    }
    if wanted("fog") {
        fog::run()?;
    }
    if wanted("parts") {
        parts::run()?;
    }
    if wanted("rain") {
        rain::run()?;
    }
    if wanted("run") {
        run::run()?;
    }
    if wanted("radiance") {
        radiance::run()?;
    }
    if wanted("wind") {
        wind::run()?;
    }
    if wanted("sea") {
        sea::run()?;
    }
    if wanted("sky") {
        sky::run()?;
    }
    if wanted("glass") {
        glass::run()?;
    }
    if wanted("gpu") {
        gpu::run()?;
    }
    if wanted("ground") {
        ground::run()?;
    }
    if wanted("land") {
        land::run()?;
    }
    if wanted("noise") {
        noise::run()?;
    }
    Ok(())
}

//! The page that shows and explains the lab's measurements, written from the CSV files beside it.

use std::fmt::Write as _;
use std::path::Path;

use welkin::Result;

use crate::chart::points;
use crate::day;
use crate::peers;
use crate::plot::short;
use crate::stability;
use crate::store::Table;

/// Writes `README.md` into the lab's directory.
///
/// # Errors
/// Files.
pub fn write(directory: &Path) -> Result<()> {
    let read = |name: &str| Table::read(&directory.join(format!("{name}.csv")));
    let (sky, fog, quadrature, growth) = (read("sky")?, read("fog")?, read("quadrature")?, read("growth")?);
    let (rain, snow, stars, clouds) = (read("rain")?, read("snow")?, read("stars")?, read("clouds")?);
    let (painted, others, played) = (read("painted-clouds")?, read("peers")?, read("run")?);
    let mut out = String::from(
        "# The lab: speed against accuracy, and where methods fail\n\n\
         Written by `make lab` (`examples/lab`); the numbers are in the CSV files beside this page. \
         [Rain](rain.md) and\n\
         [wet ground](ground.md) have pages of what the tests measure; [on a GPU](gpu.md) has milliseconds of every effect,\n\
         [counts](counts.md) what a GPU does for a pixel.\n\n",
    );
    if let Some(table) = &others {
        peers::section(&mut out, table);
    }
    if let Some(table) = &played {
        day::section(&mut out, table)?;
    }
    if let Some(table) = &sky {
        sky_section(&mut out, table);
    }
    if let Some(table) = &quadrature {
        quadrature_section(&mut out, table);
    }
    if let Some(table) = &fog {
        fog_section(&mut out, table);
    }
    if let Some(table) = &rain {
        rain_section(&mut out, table);
    }
    if let Some(table) = &snow {
        by_scene(&mut out, table, ("Which snow", "snow", "blocks"), SNOW_SAYS);
    }
    if let Some(table) = &stars {
        star_section(&mut out, table);
    }
    if let Some(table) = &clouds {
        by_scene(&mut out, table, ("Which clouds", "clouds", "pixels"), CLOUDS_SAYS);
    }
    if let Some(table) = &painted {
        by_scene(&mut out, table, ("Painted clouds", "painted-clouds", "blocks"), PAINTED_SAYS);
    }
    if let Some(table) = &growth {
        growth_section(&mut out, table);
    }
    stability::section(&mut out, directory)?;
    how_section(&mut out, [&sky, &fog, &rain, &snow, &stars, &clouds, &painted, &quadrature, &growth]);
    let path = directory.join("README.md");
    welkin_command_line::write_whole(&path, out.as_bytes())
}

const QUADRATURE_SAYS: &str = "\nWith the sun up, nodes on the stretch err far less than on the plain ray, and Gauss panels far less than \
    midpoints. After sunset a ray is cut at the shadow's edge and each part takes three fifths of the nodes: those rays alone \
    make up the 95th percentile of `welkin` in the chart, and midpoints, which are not cut, have the lower one there.\n\n";

fn number(table: &Table, row: &[String], column: &str) -> f64 {
    table.number(row, column).unwrap_or(f64::NAN)
}

fn percent(v: f64) -> String {
    format!("{} %", short(100.0 * v))
}

fn bytes(v: f64) -> String {
    if v >= 1e6 { format!("{} MB", short(v / 1e6)) } else { format!("{} kB", short(v / 1e3)) }
}

/// Rows on the front, and the default, in order of cost.
fn front_rows(table: &Table, cost: &str) -> Vec<(bool, bool, Vec<String>)> {
    let mut points = points(table, cost);
    points.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let row = |name: &str| table.row(name).map(<[String]>::to_vec);
    points.iter().filter(|p| p.front || p.default).filter_map(|p| Some((p.front, p.default, row(&p.name)?))).collect()
}

fn sky_section(out: &mut String, t: &Table) {
    let n = |r: &[String], c: &str| number(t, r, c);
    out.push_str("## Which sky\n\n");
    let default = t.rows.iter().find(|r| r[2] == "true");
    let source = ["elek-15", "elek-50"].map(|name| t.row(name));
    if let Some(d) = default {
        // Time per unit of cost while the machine is least busy.
        let unit = |r: &Vec<String>| n(r, "moving_ms") / n(r, "cost");
        let calm = t.rows.iter().map(unit).fold(f64::INFINITY, f64::min);
        let on = front_rows(t, "cost").iter().any(|(front, default, _)| *front && *default);
        let _ = write!(
            out,
            "Take the default, `{}`: 95 % of all pixels are within {} of the truth, at {} ms a frame whose sun has moved and \
             {} ms otherwise (320x180 on this software driver), and {} once an air. It {} the front: {} here is both \
             cheaper and better. ",
            d[0],
            percent(n(d, "p95")),
            short(calm * n(d, "cost")),
            short(calm * n(d, "still")),
            format_args!("{} s", short(n(d, "rebuild_s"))),
            if on { "lies on" } else { "lies beside" },
            if on { "nothing" } else { "something" },
        );
        for s in source.into_iter().flatten() {
            let _ = write!(
                out,
                "`{}` (the table of single scattering of 2008) errs by {} and takes {} s to build. ",
                s[0],
                percent(n(s, "p95")),
                short(n(s, "rebuild_s"))
            );
        }
        out.push_str("\n\n");
    }
    out.push_str("![cost of a frame against error](sky.svg)\n\n");
    out.push_str(
        "On the front, cheapest first; costs over the baseline's, quarters of the measurements in brackets:\n\n",
    );
    out.push_str(
        "| sky | cost | sun at rest | build, s | error p95 | median | worst | perceptual | shared | per view |\n",
    );
    out.push_str("|---|---|---|---|---|---|---|---|---|---|\n");
    for (front, default, r) in front_rows(t, "cost") {
        let mark = match (front, default) {
            (true, true) => " (default)",
            (false, true) => " (default, beaten)",
            _ => "",
        };
        let _ = writeln!(
            out,
            "| `{}`{mark} | {} ({} to {}) | {} | {} | {} | {} | {} | {} | {} | {} |",
            r[0],
            short(n(&r, "cost")),
            short(n(&r, "cost_low")),
            short(n(&r, "cost_high")),
            short(n(&r, "still")),
            short(n(&r, "rebuild_s")),
            percent(n(&r, "p95")),
            percent(n(&r, "median")),
            percent(n(&r, "worst")),
            percent(n(&r, "perceptual")),
            bytes(n(&r, "shared_bytes")),
            bytes(n(&r, "view_bytes")),
        );
    }
    out.push_str(
        "\nWhere the sun and the observer's altitude stay, the observer's tables stay too and a frame is cheaper:\n\n",
    );
    out.push_str("![cost of a further frame against error](sky-still.svg)\n\n");
    out.push_str("Error by scene, 95th percentile, per cent:\n\n| sky |");
    let scenes = end_heading(out, t, 1);
    for r in &t.rows {
        let _ = write!(out, "| `{}` |", r[0]);
        scenes.iter().for_each(|s| {
            let _ = write!(out, " {} |", short(100.0 * n(r, s)));
        });
        out.push('\n');
    }
    out.push_str(
        "\n`directional` carries the orders of scattering one by one with their direction, `isotropic` takes all orders after the \
         first as equal in all directions, `table3d` has light scattered once from a table, `march-N` marches it in every pixel \
         with N nodes, `elek-N` is the table of 2008 with N steps an integral, mended only where it could not be computed as \
         printed (`examples/lab/src/sky/elek.rs` says how). `-fine-planet` and `-fine-view` double one half of the default's \
         tables each.\n\n",
    );
}

fn quadrature_section(out: &mut String, t: &Table) {
    out.push_str(
        "## Which quadrature\n\nThe same integrals by the same shader functions, only the nodes differ. Transmittance needs no nodes: \
         the closed form is better than any rule of its cost. Light scattered once takes Gauss panels of 4 on nodes spread as \
         the air is, cut at the edges of the planet's shadow (`welkin`). `offset-0.3` is the rule of much public code: its last step is missing, so it converges to first \
         order only.\n\n\
         ![transmittance](quadrature-transmittance.svg)\n\n![light scattered once](quadrature-scattering.svg)\n\n",
    );
    let at = |name: &str, column: &str| t.row(name).map_or(f64::NAN, |r| number(t, r, column));
    out.push_str("| light scattered once, 20 nodes | cost | median | p95, sun at 30 deg | 75 | 88 | 92 | worst |\n");
    out.push_str("|---|---|---|---|---|---|---|---|\n");
    for rule in ["offset-0.3", "midpoint", "trapezoid", "gauss-4", "midpoint-stretched", "welkin"] {
        let name = format!("scattering/{rule} 20");
        let [a, b, c, d] = crate::quadrature::SUN_COLUMNS;
        let errors = ["median", a, b, c, d, "worst"].map(|c| percent(at(&name, c)));
        let _ = writeln!(out, "| {rule} | {} | {} |", short(at(&name, "cost")), errors.join(" | "));
    }
    out.push_str(QUADRATURE_SAYS);
}

fn fog_section(out: &mut String, t: &Table) {
    let n = |r: &[String], c: &str| number(t, r, c);
    out.push_str(
        "## Which fog\n\nErrors are against the fog's own law in f64, for the laws differ in what they mean by a visibility. How far the \
         layer's light is from adding and doubling is in `src/fog/mod.rs`, held by `tests/fog/light.rs`.\n\n\
         ![cost of fog against error](fog.svg)\n\n",
    );
    out.push_str(
        "| fog | cost | error p95 | median | worst | perceptual | per view |\n|---|---|---|---|---|---|---|\n",
    );
    for r in &t.rows {
        let mark = if r[2] == "true" { " (default)" } else { "" };
        let _ = writeln!(
            out,
            "| `{}`{mark} | {} ({} to {}) | {} | {} | {} | {} | {} |",
            r[0],
            short(n(r, "cost")),
            short(n(r, "cost_low")),
            short(n(r, "cost_high")),
            percent(n(r, "p95")),
            percent(n(r, "median")),
            percent(n(r, "worst")),
            percent(n(r, "perceptual")),
            bytes(n(r, "view_bytes")),
        );
    }
    out.push_str(
        "\nThe truth is the closed form in f64 at every pixel, whose own error of light against adding and doubling is held in \
         `tests/fog/light.rs`. `even` leaves the patches out: exact where there are none, and cheaper where there are. The \
         froxels are what hosts' transparent shaders sample; in a whole picture they blur the layer's top and the near masts. \
         The older laws have the layer's visibility and the light of a deep layer, but know neither top nor sun: good for a host \
         that must look as it always did, and for nothing else.\n\n",
    );
}

const RAIN_SAYS: &str = "\n`drops-and-cones` is the default: single drops to 1.9 m, cones beyond. `cones` are streaks on three nested cones; \
    they cost the same at any rate and have no splashes. `drops-N` are at most N drops without a state to 4 m, each in \
    its own place on every channel. `veil` has no drops. The truth is every drop before the camera up to 14.8 m, one by \
    one in f64. `truth-again` is all drops in other places: no way to draw can be nearer to the truth. No two ways put \
    drops in the same places, so blocks of 20 x 20 pixels are compared over six moments: their mean, and their contrast \
    from pixel to pixel and from patch to patch of 4 x 4. The error is the worst of the three over the mean plus a \
    hundredth of white. `source-N` are drops that get fewer and larger with distance (replicated: six copies of each), \
    as in an older system, timed by as many quads. Drops are listed by compute shaders; `cargo bench -- rain` prints \
    what they cost without.\n\n";

fn rain_section(out: &mut String, t: &Table) {
    let n = |r: &[String], c: &str| number(t, r, c);
    out.push_str("## Which rain\n\n![cost of rain against error](rain.svg)\n\n");
    out.push_str(
        "Costs of fog and rain alone; error by scene, 95th percentile, per cent:\n\n| rain | cost | all by day |",
    );
    let scenes = end_heading(out, t, 3);
    for r in &t.rows {
        let cost = if n(r, "cost") > 0.0 {
            format!("{} ({} to {})", short(n(r, "cost")), short(n(r, "cost_low")), short(n(r, "cost_high")))
        } else {
            "-".into()
        };
        let _ = write!(out, "| `{}` | {cost} | {} |", r[0], short(100.0 * n(r, "p95")));
        scenes.iter().for_each(|s| {
            let _ = write!(out, " {} |", short(100.0 * n(r, s)));
        });
        out.push('\n');
    }
    out.push_str(RAIN_SAYS);
}

const STARS_SAYS: &str = "\n`make lab ARGS=\"chart stars\"` draws these. `visible-stars` is the default: the glow, and the points that an eye \
    could see against the sky. `all-stars` are all 9096 of the catalogue and the planets, however faint. The truth is all of them \
    and the glow at every pixel in f64, in the place of the even night of the same picture. A star is a few pixels, so the means \
    of blocks of 20 x 20 pixels are compared. *Light* is the worst scene's error of all light that stands on the even night.\n\n";

const SNOW_SAYS: &str = "\nThe truth is every flake of the air within 14.8 m by itself, in f64, against which each way to draw is \
    compared as rain is. Flakes of which there is no room are stood for by others, as many of each class as makes all hide the same; a \
    shell of the lattice is left to the veil where its contrast would be off by more than the square root of 3.\n\n";

/// A chart and the table of its rows by scene.
fn by_scene(out: &mut String, t: &Table, (title, name, what): (&str, &str, &str), says: &str) {
    let n = |r: &[String], c: &str| number(t, r, c);
    let _ = write!(out, "## {title}\n\n![cost of {name} against error]({name}.svg)\n\n");
    let _ = write!(out, "Error of {what} by scene, 95th percentile, per cent:\n\n| {name} | cost | all |");
    let scenes = end_heading(out, t, 3);
    for r in &t.rows {
        let mark = if r[2] == "true" { " (default)" } else { "" };
        let cost = format!("{} ({} to {})", short(n(r, "cost")), short(n(r, "cost_low")), short(n(r, "cost_high")));
        let _ = write!(out, "| `{}`{mark} | {cost} | {} |", r[0], short(100.0 * n(r, "p95")));
        scenes.iter().for_each(|s| {
            let _ = write!(out, " {} |", short(100.0 * n(r, s)));
        });
        out.push('\n');
    }
    out.push_str(says);
}

const CLOUDS_SAYS: &str = "\n`make lab ARGS=\"chart clouds\"` draws these. `volume-double-steps` is the default: it marches a sixteenth of the \
    pixels in a frame and takes the others over from earlier ones, `quarter-of-pixels` a quarter, `every-pixel` all. The truth is every pixel in \
    four times as many steps; pictures are compared once they have settled, and timed while the camera turns.\n\n";

const PAINTED_SAYS: &str = "\nWhat older systems paint, over Welkin's own clear sky and in its light, cut to the cover of the scene: a \
    `plane` of noise under an exponential opacity in one colour; the same lit by the noise on the way to the sun (`traced`), by a normal from \
    its slope, by the average with a second texture; fading from noise to noise, swirled along the level lines of another; a `dome` that cuts a \
    sphere out of solid noise; a `sky-picture` taken while the sun stood 15 degrees lower. A `shell` is a plane that is bent as the planet is, \
    `solid-shell` the dome's noise where a ray meets it, `slab` the light of an even slab as deep as the place. No two put clouds in the same \
    places, so blocks are compared as in rain, over sixteen moments. `truth-again` is the \
    truth at other moments: what has its clouds elsewhere cannot be nearer; Welkin's ways have them where the truth has.\n\n";

/// Ends the heading of a table, of `other` columns so far, with a column for each scene. Returns the scenes' columns.
fn end_heading<'t>(out: &mut String, t: &'t Table, other: usize) -> Vec<&'t String> {
    let scenes: Vec<&String> = t.columns.iter().filter(|c| c.starts_with("p95_")).collect();
    scenes.iter().for_each(|s| {
        let _ = write!(out, " {} |", s.trim_start_matches("p95_"));
    });
    out.push_str("\n|");
    out.push_str(&"---|".repeat(other + scenes.len()));
    out.push('\n');
    scenes
}

fn star_section(out: &mut String, t: &Table) {
    let n = |r: &[String], c: &str| number(t, r, c);
    out.push_str("## Which stars\n\n![cost of stars against error](stars.svg)\n\n");
    out.push_str("Error of blocks by scene, 95th percentile, per cent:\n\n| night | cost | light | all |");
    let scenes = end_heading(out, t, 4);
    for r in &t.rows {
        let mark = if r[2] == "true" { " (default)" } else { "" };
        let cost = format!("{} ({} to {})", short(n(r, "cost")), short(n(r, "cost_low")), short(n(r, "cost_high")));
        let _ =
            write!(out, "| `{}`{mark} | {cost} | {} | {} |", r[0], percent(n(r, "flux")), short(100.0 * n(r, "p95")));
        scenes.iter().for_each(|s| {
            let _ = write!(out, " {} |", short(100.0 * n(r, s)));
        });
        out.push('\n');
    }
    out.push_str(STARS_SAYS);
}

fn growth_section(out: &mut String, t: &Table) {
    out.push_str("## Growth\n\n![growth of time](growth-time.svg)\n\n![growth of bytes](growth-bytes.svg)\n\n");
    out.push_str("| what | against | exponent of time | of bytes | |\n|---|---|---|---|---|\n");
    for (name, against, time, bytes) in crate::growth::exponents(t) {
        let show = |v: Option<(f64, f64)>| v.map_or("-".into(), |(p, _)| short(p));
        let worst = [time, bytes].iter().flatten().map(|p| p.0).fold(0.0, f64::max);
        let say = if worst > crate::growth::LINEAR { "**worse than linear**" } else { "" };
        let _ = writeln!(out, "| {name} | {against} | {} | {} | {say} |", show(time), show(bytes));
    }
    out.push('\n');
    crate::wind_flakes::section(out, t);
}

fn how_section(out: &mut String, tables: [&Option<Table>; 9]) {
    out.push_str(
        "## How it was measured\n\n\
         - **Error**: |Y_A - Y_B| / (Y_B + 0.01 Y_white) in luminance after exposure, B the reference in f64, over all pixels of all \
         scenes; white is where the logarithmic mean lies at 18 %. *Perceptual* is 1 less the similarity of structure and colour \
         of the displayed pictures.\n\
         - **Cost**: wall time of a submit that is waited for, over that of a fixed load (64 exponentials in every pixel of 320x180) \
         run before and after each frame; the median of the ratios with the quarters on both sides. A point has moved when \
         these ranges part.\n\
         - **Truth of the sky**: every order of scattering, in double precision along each pixel's ray; its source on a grid that is \
         good to 0.1 % (`src/sky/reference`). The ground's colour is the same for all.\n",
    );
    for table in tables.into_iter().flatten() {
        let dates: Vec<&String> = table
            .columns
            .iter()
            .position(|c| c == "date")
            .map_or(Vec::new(), |i| table.rows.iter().map(|r| &r[i]).collect());
        let date = dates.iter().max().map_or(String::new(), |d| format!("; {d}"));
        let what = table.note.split(';').next().unwrap_or_default();
        let old =
            if table.note.ends_with(&crate::chart::shaders(what)) { "" } else { "; the shaders have changed since" };
        let _ = writeln!(out, "- {}{date}{old}.", table.note);
    }
}

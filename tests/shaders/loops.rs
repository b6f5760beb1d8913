//! Every loop of every shader ends, whatever values the blocks, buffers and textures hold. If a driver gives a shader
//! the bytes of another block, the result must be a wrong picture and not a GPU that hangs: Welkin switches wgpu's own
//! limit off (`force_loop_bounding`).

use std::{
    collections::{BTreeMap, BTreeSet, HashSet},
    ops::Range as Place,
};

use wgpu::naga::{
    BinaryOperator as B, Block, Expression as E, Function, Handle, LocalVariable, MathFunction as M, Statement,
    UnaryOperator,
};

use super::{
    accepted::LOOPS,
    all_shaders,
    ranges::{Shader, same, statements, target},
    text,
    value::{Range, Value},
};

type Expression = Handle<wgpu::naga::Expression>;

/// Greatest number of turns of a loop: more than a march of 4,096 cells needs, and more than a thread's part of the
/// longest list.
const MOST_TURNS: f64 = 262_144.0;

/// Whether the first statement of a loop's body ends it at some turn: `if !(i < end) { break; }`, where `end` has a
/// limit and the counter `i` only grows.
fn ends(function: &Function, body: &Block, continuing: &Block, values: &[Value]) -> bool {
    body.iter().any(|statement| {
        let Statement::If { condition, accept, reject } = statement else { return false };
        let stops = |block: &Block| block.iter().any(|s| matches!(s, Statement::Break | Statement::Return { .. }));
        // `while` and `for` break where their condition does not hold.
        let (holds, condition) = match function.expressions[*condition] {
            E::Unary { op: UnaryOperator::LogicalNot, expr } => (stops(accept), expr),
            _ => (stops(reject), *condition),
        };
        holds && is_limited(function, condition, (body, continuing), values)
    })
}

fn is_limited(
    function: &Function,
    condition: Expression,
    (body, continuing): (&Block, &Block),
    values: &[Value],
) -> bool {
    match function.expressions[condition] {
        // With `&&` one side is enough: naga keeps the sides in a variable.
        E::Load { pointer } => sides(function, body, pointer)
            .into_iter()
            .any(|value| is_limited(function, value, (body, continuing), values)),
        E::Binary { op: B::LogicalAnd, left, right } => {
            [left, right].into_iter().any(|side| is_limited(function, side, (body, continuing), values))
        }
        E::Binary { op: B::Less | B::LessEqual, left, right } => {
            counts_up(function, left, (body, continuing))
                && (limit(values, right) <= MOST_TURNS || is_from_start(function, left, right))
        }
        E::Binary { op: B::Greater | B::GreaterEqual, left, right } => {
            // An integer that is halved each turn is 0 after 32 turns.
            (steps(function, left, (body, continuing), &[B::Divide]) && least(values, right) >= 0.0)
                || (steps(function, left, (body, continuing), &[B::Subtract]) && limit(values, left) <= MOST_TURNS)
        }
        _ => false,
    }
}

fn limit(values: &[Value], expression: Expression) -> f64 {
    values[expression.index()].whole().hi
}

fn least(values: &[Value], expression: Expression) -> f64 {
    values[expression.index()].whole().lo
}

/// The sides of an `&&` that is kept in a variable: `if left { both = right; } else { both = false; }`.
fn sides(function: &Function, body: &Block, pointer: Expression) -> Vec<Expression> {
    let mut all = Vec::new();
    statements(body, &mut |s| {
        let Statement::If { condition, accept, .. } = s else { return };
        let stored = accept.iter().find_map(|s| match s {
            Statement::Store { pointer: other, value } if same(function, *other, pointer) => Some(*value),
            _ => None,
        });
        all.extend(stored.into_iter().flat_map(|value| [*condition, value]));
    });
    all
}

/// Variable from which a counter is read, perhaps with a number added.
fn counter(function: &Function, read: Expression) -> Option<Handle<LocalVariable>> {
    match function.expressions[read] {
        E::Load { pointer } => target(function, pointer).map(|(variable, _)| variable),
        E::Binary { op: B::Add, left, right } if matches!(function.expressions[right], E::Literal(_)) => {
            counter(function, left)
        }
        _ => None,
    }
}

fn steps(function: &Function, read: Expression, (body, continuing): (&Block, &Block), by: &[B]) -> bool {
    let Some(variable) = counter(function, read) else { return false };
    let (mut fits, mut moves) = (true, false);
    for block in [body, continuing] {
        statements(block, &mut |s| {
            let Statement::Store { pointer, value } = s else { return };
            if target(function, *pointer).map(|(v, _)| v) != Some(variable) {
                return;
            }
            let is_step = match function.expressions[*value] {
                E::Binary { op, left, right } => {
                    by.contains(&op) && counter(function, left) == Some(variable) && is_number(function, right)
                }
                _ => false,
            };
            fits &= is_step;
            moves |= is_step;
        });
    }
    // The step must be where every turn passes: a step in a branch could be skipped.
    fits && moves && [body, continuing].into_iter().any(|block| always_stores(function, block, variable))
}

fn always_stores(function: &Function, block: &Block, variable: Handle<LocalVariable>) -> bool {
    block.iter().any(|s| match s {
        Statement::Store { pointer, .. } => target(function, *pointer).map(|(v, _)| v) == Some(variable),
        Statement::Block(inner) => always_stores(function, inner, variable),
        _ => false,
    })
}

fn is_number(function: &Function, expression: Expression) -> bool {
    matches!(function.expressions[expression], E::Literal(_) | E::Constant(_))
}

fn counts_up(function: &Function, read: Expression, blocks: (&Block, &Block)) -> bool {
    steps(function, read, blocks, &[B::Add])
}

/// Whether the end is at most some number beyond where the counter starts: `min(first + 32u, all)` after
/// `var i = first`.
fn is_from_start(function: &Function, read: Expression, end: Expression) -> bool {
    let Some(variable) = counter(function, read) else { return false };
    let E::Math { fun: M::Min, arg, arg1: Some(arg1), .. } = function.expressions[end] else { return false };
    let mut starts = Vec::new();
    statements(&function.body, &mut |s| {
        if let Statement::Store { pointer, value } = s
            && target(function, *pointer).map(|(v, _)| v) == Some(variable)
        {
            starts.push(*value);
        }
    });
    [arg, arg1].into_iter().any(|side| match function.expressions[side] {
        E::Binary { op: B::Add, left, right } => {
            is_number(function, right) && starts.iter().any(|start| same(function, *start, left))
        }
        _ => false,
    })
}

/// Range of a pipeline constant: Welkin sets it when it makes the pipeline, and none that ends a loop is above 64.
fn constant(name: &str) -> Option<Range> {
    let is_constant = name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
    is_constant.then_some(Range::new(0.0, 64.0))
}

/// Loops for which no end is proven, by function and first line; also the number of all loops.
fn endless(text: &str) -> (BTreeSet<(String, String)>, usize) {
    let mut shader = Shader::new(text, &constant);
    let (mut faults, mut loops) = (BTreeSet::new(), HashSet::new());
    shader.each_call(|shader, of, name, values| {
        let function = shader.function(of);
        each_loop(&function.body, &mut |body, continuing, at| {
            let line = text[at].lines().next().unwrap_or_default().trim().to_owned();
            loops.insert((name.to_owned(), line.clone()));
            if !ends(function, body, continuing, values) {
                faults.insert((name.to_owned(), line));
            }
        });
    });
    (faults, loops.len())
}

fn each_loop<'a>(block: &'a Block, with: &mut dyn FnMut(&'a Block, &'a Block, Place<usize>)) {
    for (statement, span) in block.span_iter() {
        match statement {
            Statement::Block(inner) => each_loop(inner, with),
            Statement::If { accept, reject, .. } => [accept, reject].into_iter().for_each(|b| each_loop(b, with)),
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| each_loop(&case.body, with)),
            Statement::Loop { body, continuing, .. } => {
                with(body, continuing, span.to_range().expect("a place in the source"));
                [body, continuing].into_iter().for_each(|b| each_loop(b, with));
            }
            _ => {}
        }
    }
}

#[test]
fn every_loop_ends_whatever_its_blocks_hold() {
    let mut found: BTreeMap<(String, String), String> = BTreeMap::new();
    let mut loops = 0;
    for name in all_shaders() {
        let (faults, count) = endless(&text(&name));
        loops += count;
        for fault in faults {
            found.entry(fault).or_insert_with(|| name.clone());
        }
    }
    assert!(loops > 300, "{loops} are found");
    let is_known = |(function, line): &(String, String)| LOOPS.iter().any(|(f, l, _)| f == function && l == line);
    for ((function, line), shader) in found.iter().filter(|(fault, _)| !is_known(fault)) {
        println!("    (\"{function}\", \"{line}\", \"\"), // {shader}");
    }
    assert_eq!(found.keys().filter(|fault| !is_known(fault)).count(), 0, "loops whose end a block may lift");
    let is_found = |entry: &&(&str, &str, &str)| found.contains_key(&(entry.0.to_owned(), entry.1.to_owned()));
    let stale: Vec<_> = LOOPS.iter().filter(|entry| !is_found(entry)).collect();
    assert!(stale.is_empty(), "no longer there, or seen to end: {stale:?}");
}

#[test]
fn a_loop_whose_end_a_block_sets_is_found() {
    let shader = |end: &str, step: &str| {
        format!(
            "struct Block {{ count: u32 }} @group(0) @binding(0) var<uniform> block: Block;
            fn sum(most: u32) -> f32 {{
                var all = 0.0;
                for (var i = 0u; i < {end}; {step}) {{ all += f32(i); }}
                return all;
            }}
            @fragment fn main() -> @location(0) vec4f {{ return vec4f(sum(min(block.count, 9u))); }}"
        )
    };
    let count = |end, step| endless(&shader(end, step)).0.len();
    assert_eq!([count("block.count", "i++"), count("block.count * 4u", "i += 2u")], [1, 1]);
    assert_eq!(
        [count("most", "i++"), count("(block.count & 15u)", "i++"), count("2u * min(7u, block.count)", "i++")],
        [0; 3]
    );
    assert_eq!(count("most", "i *= 2u"), 1, "a counter that does not count");
}

/// The limits of the sky's loops are the upper ends of the settings' ranges: no accepted setting is cut.
#[test]
fn the_limits_of_the_skys_loops_are_the_upper_ends_of_its_settings() {
    use welkin::sky::SkySettings;
    let maps = text("sky/maps.wgsl");
    let cap = |name: &str| {
        let line = maps.lines().find_map(|l| l.strip_prefix(&format!("const {name}: u32 = "))).expect("a constant");
        line.trim_end_matches("u;").parse::<u32>().expect("a number")
    };
    type Set = fn(&mut SkySettings, u32);
    let settings: [(&str, Set); 6] = [
        ("MOST_RULE_ZENITHS", |s, v| s.rule_zeniths = v),
        ("MOST_RULE_AZIMUTHS", |s, v| s.rule_azimuths = v),
        ("MOST_BUILD_PANELS", |s, v| s.build_panels = v),
        ("MOST_SKY_PANELS", |s, v| s.sky_panels = v),
        ("MOST_AIR_PANELS", |s, v| s.air_panels = v),
        ("MOST_MARCH_PANELS", |s, v| s.march_cells = 4 * v),
    ];
    for (name, set) in settings {
        let accepts = |value| {
            let mut all = SkySettings::default();
            set(&mut all, value);
            all.check().is_ok()
        };
        assert!(accepts(cap(name)) && !accepts(cap(name) + 1), "{name}");
    }
}

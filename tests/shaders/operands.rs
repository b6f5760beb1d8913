//! Operations that have no result for some operands: divisions, remainders, roots, logarithms, powers, inverse cosines
//! and sines, unit vectors. In every shader the ranges of their operands are proven safe, or the operation is listed
//! with the reason why it is safe.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use wgpu::naga::{BinaryOperator, Expression as E, Expression, Function, Handle, MathFunction as M, ScalarKind};

use super::{
    accepted::{ACCEPTED, FIELDS},
    all_shaders,
    ranges::{Shader, same},
    text,
    value::{Range, Value},
};

/// File of functions that exist to have a result for every operand.
const GUARDED: &str = "common/guarded.wgsl";

fn fact(name: &str) -> Option<Range> {
    FIELDS.iter().find(|(known, ..)| *known == name).map(|(_, lo, hi, _)| Range::new(*lo, *hi))
}

/// Whether an operation has a result for all values that its operands may have.
fn is_safe(function: &Function, expression: &Expression, values: &[Value], is_float: bool) -> bool {
    let of = |handle: &Handle<Expression>| &values[handle.index()];
    let all = |handle: &Handle<Expression>, fits: &dyn Fn(Range) -> bool| {
        let numbers = of(handle).numbers();
        !numbers.is_empty() && numbers.iter().all(|r| fits(*r))
    };
    match expression {
        E::Binary { op: BinaryOperator::Divide | BinaryOperator::Modulo, right, .. } if is_float => {
            all(right, &Range::excludes_zero) || is_parted(function, *right)
        }
        E::Math { fun, arg, arg1, .. } => match fun {
            M::Normalize => of(arg).numbers().iter().any(|r| r.excludes_zero()),
            M::Sqrt => all(arg, &|r| r.lo >= 0.0),
            M::InverseSqrt | M::Log | M::Log2 => all(arg, &|r| r.lo > 1e-37),
            M::Acos | M::Asin => all(arg, &|r| r.is_within(Range::new(-1.0, 1.0))),
            M::Acosh => all(arg, &|r| r.lo >= 1.0),
            M::Atanh => all(arg, &|r| r.lo > -1.0 && r.hi < 1.0),
            M::Pow => {
                let rises = arg1.as_ref().is_some_and(|e| all(e, &|r| r.lo > 0.0));
                all(arg, &|r| r.lo > 1e-37 || (r.lo >= 0.0 && rises))
            }
            M::SmoothStep => {
                let Some(second) = arg1 else { return false };
                let (a, b) = (of(arg).numbers(), of(second).numbers());
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| b.add(a.negate()).excludes_zero())
            }
            _ => true,
        },
        _ => true,
    }
}

/// Whether an expression is `select(x, a, abs(x) < b)` with numbers a and b that are not 0, so that it is never near 0.
fn is_parted(function: &Function, handle: Handle<Expression>) -> bool {
    let at = |handle: Handle<Expression>| &function.expressions[handle];
    let is_number = |mut handle: Handle<Expression>| {
        while let E::Splat { value, .. } = at(handle) {
            handle = *value;
        }
        match at(handle) {
            E::Literal(_) => true,
            E::Compose { components, .. } => components.iter().all(|c| matches!(at(*c), E::Literal(_))),
            // A number may also be one of two, chosen by a sign.
            E::Select { accept, reject, .. } => [accept, reject].into_iter().all(|e| matches!(at(*e), E::Literal(_))),
            _ => false,
        }
    };
    let E::Select { condition, accept, reject } = at(handle) else { return false };
    let E::Binary { op: BinaryOperator::Less, left, right } = at(*condition) else { return false };
    let E::Math { fun: M::Abs, arg, .. } = at(*left) else { return false };
    same(function, *arg, *reject) && is_number(*accept) && is_number(*right)
}

/// Operations that are not proven safe, by function and source text.
fn unproven(text: &str) -> BTreeSet<(String, String)> {
    let mut shader = Shader::new(text, &fact);
    let guarded = guarded_functions();
    let mut faults = BTreeSet::new();
    shader.each_call(|shader, of, name, values| {
        if guarded.contains(name) {
            return;
        }
        let function = shader.function(of);
        for (handle, expression) in function.expressions.iter() {
            let inner = shader.info(of)[handle].ty.inner_with(&shader.module.types);
            let is_float = inner.scalar_kind() == Some(ScalarKind::Float);
            if !is_safe(function, expression, values, is_float) {
                let at = function.expressions.get_span(handle).to_range().expect("a place in the source");
                faults.insert((name.to_owned(), whole_call(text, at).split_whitespace().collect::<Vec<_>>().join(" ")));
            }
        }
    });
    faults
}

/// Source text of the operation at a place; for a call its arguments too.
fn whole_call(text: &str, at: std::ops::Range<usize>) -> &str {
    if !text[at.end..].starts_with('(') {
        return &text[at];
    }
    let mut depth = 0;
    let deeper = |c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth == 0
    };
    let end = text[at.end..].find(deeper).expect("the call's end");
    &text[at.start..=at.end + end]
}

fn guarded_functions() -> HashSet<String> {
    let text = text(GUARDED);
    let name = |line: &str| Some(line.strip_prefix("fn ")?.split_once('(')?.0.to_owned());
    text.lines().filter_map(name).collect()
}

#[test]
fn every_operation_has_an_answer_for_what_it_may_be_given() {
    let mut found: BTreeMap<(String, String), String> = BTreeMap::new();
    for name in all_shaders() {
        for fault in unproven(&text(&name)) {
            found.entry(fault).or_insert_with(|| name.clone());
        }
    }
    let known: BTreeSet<(&str, &str)> =
        ACCEPTED.iter().map(|(function, operation, _)| (*function, *operation)).collect();
    let is_known = |(function, operation): &(String, String)| known.contains(&(function.as_str(), operation.as_str()));
    for ((function, operation), shader) in found.iter().filter(|(fault, _)| !is_known(fault)) {
        println!("    (\"{function}\", \"{operation}\", \"\"), // {shader}");
    }
    let new = found.keys().filter(|fault| !is_known(fault)).count();
    assert_eq!(
        new, 0,
        "operations that may have no answer: guard them, or list them with the reason why they have one"
    );
    let is_found = |entry: &&(&str, &str, &str)| found.contains_key(&(entry.0.to_owned(), entry.1.to_owned()));
    let stale: Vec<_> = ACCEPTED.iter().filter(|entry| !is_found(entry)).collect();
    assert!(stale.is_empty(), "no longer there, or proven: {stale:?}");
}

#[test]
fn an_operation_without_an_answer_is_seen() {
    let count = |operation: &str| {
        unproven(&format!(
            "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {{
                let x = at.x;
                return vec4f({operation});
            }}"
        ))
        .len()
    };
    for fault in [
        "1.0 / x",
        "sqrt(x)",
        "log(x * x)",
        "pow(x, 2.0)",
        "acos(x)",
        "normalize(at.xyz).x",
        "inverseSqrt(abs(x))",
        "x % x",
    ] {
        assert_eq!(count(fault), 1, "{fault}");
    }
    for safe in [
        "1.0 / max(x, 1e-3)",
        "sqrt(x * x)",
        "log(1.0 + abs(x))",
        "acos(clamp(x, -1.0, 1.0))",
        "normalize(vec3f(at.xy, 1.0)).x",
        "1.0 / select(x, 1e-6, abs(x) < 1e-6)",
        "x / 3.0",
    ] {
        assert_eq!(count(safe), 0, "{safe}");
    }
}

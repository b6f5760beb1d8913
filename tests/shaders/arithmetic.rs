//! Ranges of the results of operators and built-in functions.

use wgpu::naga::{BinaryOperator as B, Literal, MathFunction as M};

use super::value::{ROUNDING, Range, Value};

pub fn number(literal: Literal) -> Value {
    let value = match literal {
        Literal::F64(v) | Literal::AbstractFloat(v) => v,
        Literal::F32(v) => f64::from(v),
        Literal::U32(v) => f64::from(v),
        Literal::I32(v) => f64::from(v),
        Literal::AbstractInt(v) | Literal::I64(v) => v as f64,
        Literal::Bool(v) => f64::from(u8::from(v)),
        _ => return Value::Other,
    };
    Value::scalar(Range::of(value))
}

pub fn splat(value: &Value, size: usize) -> Value {
    Value::Numbers(vec![value.whole(); size])
}

/// The value with this range for all its numbers.
pub fn all(value: Value, range: Range) -> Value {
    match value {
        Value::Numbers(numbers) => Value::Numbers(vec![range; numbers.len()]),
        Value::Parts(parts) => Value::Parts(parts.into_iter().map(|p| all(p, range)).collect()),
        Value::Each(element) => Value::Each(Box::new(all(*element, range))),
        Value::Other => Value::Other,
    }
}

/// The value with new ranges for those components of its vectors for which `of` returns one.
pub fn components(value: Value, of: &dyn Fn(usize) -> Option<Range>) -> Value {
    match value {
        Value::Numbers(numbers) => {
            Value::Numbers(numbers.iter().enumerate().map(|(i, r)| of(i).unwrap_or(*r)).collect())
        }
        Value::Each(element) => Value::Each(Box::new(components(*element, of))),
        other => other,
    }
}

pub fn not_negative(value: Value) -> Value {
    match value {
        Value::Numbers(numbers) => Value::Numbers(numbers.iter().map(|r| r.max(Range::of(0.0))).collect()),
        Value::Parts(parts) => Value::Parts(parts.into_iter().map(not_negative).collect()),
        Value::Each(element) => Value::Each(Box::new(not_negative(*element))),
        Value::Other => Value::Other,
    }
}

/// Integers beyond the range of their type wrap round: the result may then be any value.
pub fn within_type(value: Value, any: &Value) -> Value {
    match (&value, any) {
        (Value::Numbers(a), Value::Numbers(b)) => {
            let of = |(i, any): (usize, &Range)| {
                let range = a.get(i).copied().unwrap_or(Range::ALL);
                if range.is_within(*any) { range } else { *any }
            };
            Value::Numbers(b.iter().enumerate().map(of).collect())
        }
        _ => value,
    }
}

pub fn each(value: &Value, of: impl Fn(Range) -> Range) -> Value {
    match value {
        Value::Numbers(numbers) => Value::Numbers(numbers.iter().map(|r| of(*r)).collect()),
        _ => Value::Other,
    }
}

/// Applies `of` component by component; a scalar beside a vector is used for each component.
pub fn pairs(a: &Value, b: &Value, of: impl Fn(Range, Range) -> Range) -> Value {
    let (a, b) = (a.numbers(), b.numbers());
    if a.is_empty() || b.is_empty() || (a.len() != b.len() && a.len() > 1 && b.len() > 1) {
        return Value::Other;
    }
    let at = |of: &[Range], i: usize| of[i.min(of.len() - 1)];
    Value::Numbers((0..a.len().max(b.len())).map(|i| of(at(a, i), at(b, i))).collect())
}

pub fn binary(op: B, a: &Value, b: &Value, is_same: bool) -> Value {
    match op {
        B::Add => pairs(a, b, Range::add),
        B::Subtract => pairs(a, b, |a, b| if is_same { Range::of(0.0) } else { a.add(b.negate()) }),
        B::Multiply => pairs(a, b, |a, b| if is_same { a.square() } else { a.multiply(b) }),
        // An integer divided by 0 stays unchanged.
        B::Divide => pairs(a, b, |a, b| {
            if a.is_within(Range::U32) && b.lo >= 0.0 && b.lo < 1.0 && b.hi > 1.0 {
                if b.excludes_zero() { a.divide(b) } else { Range::new(0.0, f64::INFINITY) }
            } else {
                a.divide(b)
            }
        }),
        B::Modulo => pairs(a, b, |a, b| {
            let most = b.absolute().hi;
            if b.excludes_zero() { Range::new(if a.lo >= 0.0 { 0.0 } else { -most }, most) } else { Range::ALL }
        }),
        B::And => {
            pairs(a, b, |a, b| if a.lo >= 0.0 && b.lo >= 0.0 { Range::new(0.0, a.hi.min(b.hi)) } else { Range::ALL })
        }
        B::ShiftRight => pairs(a, b, |a, b| {
            if a.lo >= 0.0 { Range::new(0.0, (a.hi / b.lo.clamp(0.0, 31.0).exp2()).floor()) } else { Range::ALL }
        }),
        B::ShiftLeft => pairs(a, b, |a, b| a.multiply(Range::new(b.lo.exp2(), b.hi.exp2()))),
        B::InclusiveOr | B::ExclusiveOr => pairs(a, b, |a, b| {
            let bits = (a.hi.max(b.hi) + 1.0).log2().ceil().exp2() - 1.0;
            if a.lo >= 0.0 && b.lo >= 0.0 { Range::new(0.0, bits) } else { Range::ALL }
        }),
        B::Equal | B::NotEqual | B::Less | B::LessEqual | B::Greater | B::GreaterEqual => {
            pairs(a, b, |_, _| Range::SHARE)
        }
        B::LogicalAnd | B::LogicalOr => Value::scalar(Range::SHARE),
    }
}

pub fn math(fun: M, a: &Value, b: Option<&Value>, c: Option<&Value>, is_same: bool) -> Value {
    let other = &Value::Other;
    let (second, third) = (b.unwrap_or(other), c.unwrap_or(other));
    let unit = Range::new(-1.0 - ROUNDING, 1.0 + ROUNDING);
    let fixed = |lo: f64, hi: f64| each(a, |_| Range::new(lo, hi));
    let half_pi = std::f64::consts::FRAC_PI_2 + ROUNDING;
    let sum = |v: Value| Value::scalar(v.numbers().iter().copied().reduce(Range::add).unwrap_or(Range::ALL));
    match fun {
        M::Abs => each(a, Range::absolute),
        M::Min => pairs(a, second, Range::min),
        M::Max => pairs(a, second, Range::max),
        M::Clamp => pairs(&pairs(a, second, Range::max), third, Range::min),
        M::Saturate => each(a, |r| r.max(Range::of(0.0)).min(Range::of(1.0))),
        M::Sin | M::Cos => each(a, |_| unit),
        M::Tanh => each(a, |r| r.rising(f64::tanh)),
        M::Sinh => each(a, |r| r.rising(f64::sinh)),
        M::Asinh => each(a, |r| r.rising(f64::asinh)),
        M::Cosh => fixed(1.0, f64::INFINITY),
        M::Acos => fixed(0.0, 2.0 * half_pi),
        M::Asin | M::Atan => fixed(-half_pi, half_pi),
        M::Atan2 => fixed(-2.0 * half_pi, 2.0 * half_pi),
        M::Ceil => each(a, |r| r.rising(f64::ceil)),
        M::Floor => each(a, |r| r.rising(f64::floor)),
        M::Round => each(a, |r| r.rising(f64::round)),
        M::Trunc => each(a, |r| r.rising(f64::trunc)),
        M::Fract | M::Step => fixed(0.0, 1.0),
        M::SmoothStep => each(third, |_| Range::SHARE),
        M::Sign => fixed(-1.0, 1.0),
        M::Exp => each(a, |r| r.rising(f64::exp)),
        M::Exp2 => each(a, |r| r.rising(f64::exp2)),
        M::Log => each(a, |r| r.max(Range::of(0.0)).rising(f64::ln)),
        M::Log2 => each(a, |r| r.max(Range::of(0.0)).rising(f64::log2)),
        M::Sqrt => each(a, |r| r.max(Range::of(0.0)).rising(f64::sqrt)),
        M::InverseSqrt => each(a, |r| {
            let r = r.max(Range::of(0.0));
            Range::new(1.0 / r.hi.sqrt(), 1.0 / r.lo.sqrt())
        }),
        M::Pow => pairs(a, second, power),
        M::Dot => sum(pairs(a, second, |a, b| if is_same { a.square() } else { a.multiply(b) })),
        M::Length => {
            let Value::Numbers(squares) = sum(each(a, Range::square)) else { return Value::Other };
            Value::scalar(squares[0].rising(f64::sqrt))
        }
        M::Distance => Value::scalar(Range::NOT_NEGATIVE),
        M::Normalize => {
            each(a, |r| Range::new(if r.lo >= 0.0 { 0.0 } else { unit.lo }, if r.hi <= 0.0 { 0.0 } else { unit.hi }))
        }
        M::Fma => pairs(&pairs(a, second, Range::multiply), third, Range::add),
        M::Mix if third.numbers().iter().all(|r| r.is_within(Range::SHARE)) => pairs(a, second, Range::join),
        M::Mix => {
            let one = Value::scalar(Range::of(1.0));
            let rest = pairs(&one, third, |one, t| one.add(t.negate()));
            pairs(&pairs(a, &rest, Range::multiply), &pairs(second, third, Range::multiply), Range::add)
        }
        M::CountOneBits | M::CountLeadingZeros | M::CountTrailingZeros => fixed(0.0, 32.0),
        M::Unpack4x8unorm => Value::Numbers(vec![Range::SHARE; 4]),
        M::Unpack2x16unorm => Value::Numbers(vec![Range::SHARE; 2]),
        M::Unpack4x8snorm => Value::Numbers(vec![Range::new(-1.0, 1.0); 4]),
        M::Unpack2x16snorm => Value::Numbers(vec![Range::new(-1.0, 1.0); 2]),
        _ => Value::Other,
    }
}

/// Range of a power of a base that is not negative.
fn power(base: Range, exponent: Range) -> Range {
    if base.lo < 0.0 {
        return Range::ALL;
    }
    let corner = |b: f64, e: f64| b.powf(e);
    let corners = [
        corner(base.lo, exponent.lo),
        corner(base.lo, exponent.hi),
        corner(base.hi, exponent.lo),
        corner(base.hi, exponent.hi),
    ];
    // A base of 1 within the range gives 1, which may lie beyond all corners.
    let one = if base.lo < 1.0 && base.hi > 1.0 { 1.0 } else { corners[0] };
    let fold = |of: fn(f64, f64) -> f64, from: f64| corners.into_iter().chain([one]).fold(from, of);
    Range::new(fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY))
}

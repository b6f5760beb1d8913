//! Ranges of the values in a shader, computed from naga's form of its source: bounds that hold whatever values the
//! blocks and textures have.
//!
//! Each function is evaluated for the arguments of each of its calls. A variable may have any value that is stored in
//! it anywhere. It is first assumed not to be negative; the assumption holds if no value stored under it is negative.
//! Conditions of branches do not narrow ranges.

use std::collections::{HashMap, HashSet};

use wgpu::naga::{
    self, Block, Expression as E, Function, Handle, ImageQuery, LocalVariable, Module, ScalarKind, Statement, Type,
    TypeInner, UnaryOperator,
    valid::{self, FunctionInfo},
};

use super::{
    arithmetic::{all, binary, components, each, math, not_negative, number, splat, within_type},
    value::{Range, Value},
};

/// Range of a member of a block or of an override constant, by `Struct.member` or by the constant's name.
pub type Facts<'a> = &'a dyn Fn(&str) -> Option<Range>;

/// One of the functions of a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Of {
    Entry(usize),
    Function(Handle<Function>),
}

/// Values of a function's expressions and variables for some arguments.
#[derive(Clone)]
pub struct Evaluated {
    pub values: Vec<Value>,
    result: Value,
}

pub struct Shader<'a> {
    pub module: Module,
    pub info: valid::ModuleInfo,
    facts: Facts<'a>,
    known: HashMap<(Of, String), Evaluated>,
}

/// A call within a function's body.
pub struct Call {
    pub function: Handle<Function>,
    pub arguments: Vec<Handle<naga::Expression>>,
    result: Option<Handle<naga::Expression>>,
}

/// All statements of a block and of the blocks in it.
pub fn statements<'a>(block: &'a Block, with: &mut dyn FnMut(&'a Statement)) {
    for statement in block.iter() {
        with(statement);
        match statement {
            Statement::Block(inner) => statements(inner, with),
            Statement::If { accept, reject, .. } => [accept, reject].into_iter().for_each(|b| statements(b, with)),
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| statements(&case.body, with)),
            Statement::Loop { body, continuing, .. } => {
                [body, continuing].into_iter().for_each(|b| statements(b, with));
            }
            _ => {}
        }
    }
}

pub fn calls(function: &Function) -> Vec<Call> {
    let mut all = Vec::new();
    statements(&function.body, &mut |s| {
        if let Statement::Call { function, arguments, result } = s {
            all.push(Call { function: *function, arguments: arguments.clone(), result: *result });
        }
    });
    all
}

/// Variable that a pointer leads into, and the path to the part that it points to.
pub fn target(
    function: &Function,
    pointer: Handle<naga::Expression>,
) -> Option<(Handle<LocalVariable>, Vec<Option<u32>>)> {
    match function.expressions[pointer] {
        E::LocalVariable(variable) => Some((variable, Vec::new())),
        E::Access { base, .. } => {
            let (variable, mut path) = target(function, base)?;
            path.push(None);
            Some((variable, path))
        }
        E::AccessIndex { base, index } => {
            let (variable, mut path) = target(function, base)?;
            path.push(Some(index));
            Some((variable, path))
        }
        _ => None,
    }
}

impl<'a> Shader<'a> {
    pub fn new(text: &str, facts: Facts<'a>) -> Self {
        let module = naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
        let mut validator = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::all());
        let info = validator.validate(&module).expect("a valid shader");
        Self { module, info, facts, known: HashMap::new() }
    }

    pub fn function(&self, of: Of) -> &Function {
        match of {
            Of::Entry(at) => &self.module.entry_points[at].function,
            Of::Function(handle) => &self.module.functions[handle],
        }
    }

    pub fn info(&self, of: Of) -> &FunctionInfo {
        match of {
            Of::Entry(at) => self.info.get_entry_point(at),
            Of::Function(handle) => &self.info[handle],
        }
    }

    /// All entry points, with arguments of any value; in the snippets for hosts' own shaders all functions.
    fn roots(&self) -> Vec<(Of, Vec<Value>)> {
        let entries = (0..self.module.entry_points.len()).map(Of::Entry);
        let functions = self.module.functions.iter();
        let is_snippet = |f: &Function| f.name.as_deref().is_some_and(|name| name.starts_with("welkin_"));
        let snippets = functions.filter(|(_, f)| is_snippet(f)).map(|(handle, _)| Of::Function(handle));
        let any = |of: &Of| self.function(*of).arguments.iter().map(|a| self.argument(a)).collect();
        entries.chain(snippets).map(|of| (of, any(&of))).collect()
    }

    fn argument(&self, argument: &naga::FunctionArgument) -> Value {
        match argument.binding {
            // No workgroup has more invocations.
            Some(naga::Binding::BuiltIn(naga::BuiltIn::LocalInvocationIndex)) => Value::scalar(Range::new(0.0, 1023.0)),
            _ => self.any(argument.ty),
        }
    }

    /// Value of which only its type and the facts about its members are known.
    pub fn any(&self, ty: Handle<Type>) -> Value {
        self.any_of(&self.module.types[ty].inner, self.module.types[ty].name.as_deref())
    }

    fn any_of(&self, inner: &TypeInner, name: Option<&str>) -> Value {
        let range = |kind| match kind {
            ScalarKind::Uint => Range::U32,
            ScalarKind::Sint => Range::I32,
            ScalarKind::Bool => Range::SHARE,
            _ => Range::ALL,
        };
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Value::scalar(range(scalar.kind)),
            TypeInner::Vector { size, scalar } => Value::Numbers(vec![range(scalar.kind); *size as usize]),
            TypeInner::Array { base, .. } => Value::Each(Box::new(self.any(*base))),
            TypeInner::Struct { members, .. } => {
                let known = |at: &str| (self.facts)(&format!("{}.{at}", name?));
                let of = |m: &naga::StructMember| {
                    let (at, any) = (m.name.as_deref().unwrap_or_default(), self.any(m.ty));
                    let any = known(at).map_or(any.clone(), |range| all(any, range));
                    components(any, &|i| known(&format!("{at}.{}", ["x", "y", "z", "w"][i])))
                };
                Value::Parts(members.iter().map(of).collect())
            }
            _ => Value::Other,
        }
    }

    fn zero(&self, ty: Handle<Type>) -> Value {
        all(self.any(ty), Range::of(0.0))
    }

    fn global(&self, handle: Handle<naga::Expression>) -> Value {
        let at = &self.module.global_expressions;
        match &at[handle] {
            E::Constant(constant) => self.global(self.module.constants[*constant].init),
            E::Override(over) => self.overridden(*over),
            E::Compose { ty, components } => self.composed(*ty, components.iter().map(|c| self.global(*c)).collect()),
            E::Splat { size, value } => splat(&self.global(*value), *size as usize),
            E::ZeroValue(ty) => self.zero(*ty),
            E::Literal(literal) => number(*literal),
            _ => Value::Other,
        }
    }

    fn overridden(&self, handle: Handle<naga::Override>) -> Value {
        let over = &self.module.overrides[handle];
        let known = over.name.as_deref().and_then(self.facts);
        known.map_or(self.any(over.ty), |range| all(self.any(over.ty), range))
    }

    fn composed(&self, ty: Handle<Type>, parts: Vec<Value>) -> Value {
        match self.module.types[ty].inner {
            TypeInner::Vector { .. } => Value::Numbers(parts.iter().flat_map(|p| p.numbers().to_vec()).collect()),
            TypeInner::Struct { .. } => Value::Parts(parts),
            TypeInner::Array { .. } => {
                let joined = parts.into_iter().reduce(|a, b| a.join(&b));
                Value::Each(Box::new(joined.unwrap_or(Value::Other)))
            }
            _ => Value::Other,
        }
    }

    /// Visits each function once for each set of arguments that reaches it, with its name and its values.
    pub fn each_call(&mut self, mut visit: impl FnMut(&Self, Of, &str, &[Value])) {
        let (mut open, mut seen) = (self.roots(), HashSet::new());
        while let Some((of, arguments)) = open.pop() {
            if !seen.insert((of, format!("{arguments:?}"))) {
                continue;
            }
            let values = self.evaluate(of, &arguments).values;
            let function = self.function(of);
            open.extend(calls(function).iter().map(|call| {
                let given = call.arguments.iter().map(|a| values[a.index()].clone());
                (Of::Function(call.function), given.collect())
            }));
            let name = match of {
                Of::Entry(at) => self.module.entry_points[at].name.clone(),
                Of::Function(_) => function.name.clone().unwrap_or_default(),
            };
            visit(self, of, &name, &values);
        }
    }

    /// Values of a function for these arguments.
    pub fn evaluate(&mut self, of: Of, arguments: &[Value]) -> Evaluated {
        let key = (of, format!("{arguments:?}"));
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let function = self.function(of).clone();
        let mut locals: HashMap<Handle<LocalVariable>, Value> =
            function.local_variables.iter().map(|(v, l)| (v, not_negative(self.any(l.ty)))).collect();
        let mut found = self.pass(of, &function, arguments, &locals);
        // Repeats until the stored values fit those that were assumed.
        loop {
            let stored = self.stored(&function, &found.values);
            let wrong = stored.iter().filter(|(v, held)| !held.is_within(&locals[v])).map(|(v, _)| *v);
            let any = |v: Handle<LocalVariable>| (v, self.any(function.local_variables[v].ty));
            let wider: Vec<_> = wrong.map(any).filter(|(v, any)| locals[v] != *any).collect();
            if wider.is_empty() {
                break;
            }
            locals.extend(wider);
            found = self.pass(of, &function, arguments, &locals);
        }
        for _ in 0..2 {
            locals = self.stored(&function, &found.values);
            found = self.pass(of, &function, arguments, &locals);
        }
        self.known.insert(key, found.clone());
        found
    }

    /// Values of variables, from all values that are stored in them.
    fn stored(&self, function: &Function, values: &[Value]) -> HashMap<Handle<LocalVariable>, Value> {
        let first = |l: &LocalVariable| l.init.map_or_else(|| self.zero(l.ty), |init| values[init.index()].clone());
        let mut all: HashMap<_, _> = function.local_variables.iter().map(|(v, l)| (v, first(l))).collect();
        let anything = |pointer, all: &mut HashMap<_, Value>| {
            if let Some((variable, _)) = target(function, pointer) {
                all.insert(variable, self.any(function.local_variables[variable].ty));
            }
        };
        statements(&function.body, &mut |s| match s {
            Statement::Store { pointer, value } => {
                if let Some((variable, path)) = target(function, *pointer) {
                    all.get_mut(&variable).expect("a variable").join_at(&path, &values[value.index()]);
                }
            }
            // A function may store any value through a pointer.
            Statement::Call { arguments, .. } => arguments.iter().for_each(|a| anything(*a, &mut all)),
            _ => {}
        });
        all
    }

    fn pass(
        &mut self,
        of: Of,
        function: &Function,
        arguments: &[Value],
        locals: &HashMap<Handle<LocalVariable>, Value>,
    ) -> Evaluated {
        let calls: HashMap<_, _> = calls(function).into_iter().filter_map(|c| Some((c.result?, c))).collect();
        let mut values: Vec<Value> = Vec::with_capacity(function.expressions.len());
        for (handle, expression) in function.expressions.iter() {
            let value = match expression {
                E::CallResult(called) => {
                    let given: Vec<Value> =
                        calls[&handle].arguments.iter().map(|a| values[a.index()].clone()).collect();
                    self.evaluate(Of::Function(*called), &given).result
                }
                E::FunctionArgument(at) => arguments[*at as usize].clone(),
                E::Load { pointer } => self.loaded(function, *pointer, locals),
                _ => self.value(function, expression, &values),
            };
            let any = || {
                let ty = &self.info(of)[handle].ty;
                let named = ty.handle().and_then(|h| self.module.types[h].name.as_deref());
                self.any_of(ty.inner_with(&self.module.types), named)
            };
            let value = if value == Value::Other { any() } else { within_type(value, &any()) };
            values.push(value);
        }
        let mut result: Option<Value> = None;
        statements(&function.body, &mut |s| {
            if let Statement::Return { value: Some(value) } = s {
                let value = &values[value.index()];
                result = Some(result.as_ref().map_or(value.clone(), |known| known.join(value)));
            }
        });
        Evaluated { values, result: result.unwrap_or(Value::Other) }
    }

    fn loaded(
        &self,
        function: &Function,
        pointer: Handle<naga::Expression>,
        locals: &HashMap<Handle<LocalVariable>, Value>,
    ) -> Value {
        if let Some((variable, path)) = target(function, pointer) {
            let whole = Some(locals[&variable].clone());
            return path.iter().fold(whole, |value, index| value?.part(*index)).unwrap_or(Value::Other);
        }
        match function.expressions[pointer] {
            E::GlobalVariable(global) => {
                let known = self.module.global_variables[global].name.as_deref().and_then(self.facts);
                let any = self.any(self.module.global_variables[global].ty);
                known.map_or(any.clone(), |range| all(any, range))
            }
            E::Access { base, .. } => self.loaded(function, base, locals).part(None).unwrap_or(Value::Other),
            E::AccessIndex { base, index } => {
                self.loaded(function, base, locals).part(Some(index)).unwrap_or(Value::Other)
            }
            _ => Value::Other,
        }
    }

    fn value(&self, function: &Function, expression: &naga::Expression, values: &[Value]) -> Value {
        let of = |handle: &Handle<naga::Expression>| &values[handle.index()];
        match expression {
            E::Literal(literal) => number(*literal),
            E::Constant(constant) => self.global(self.module.constants[*constant].init),
            E::Override(over) => self.overridden(*over),
            E::ZeroValue(ty) => self.zero(*ty),
            E::Compose { ty, components } => self.composed(*ty, components.iter().map(|c| of(c).clone()).collect()),
            E::Access { base, .. } => of(base).part(None).unwrap_or(Value::Other),
            E::AccessIndex { base, index } => of(base).part(Some(*index)).unwrap_or(Value::Other),
            E::Splat { size, value } => splat(of(value), *size as usize),
            E::Swizzle { size, vector, pattern } => {
                let numbers = of(vector).numbers();
                let picked = pattern[..*size as usize].iter().map(|p| numbers.get(*p as usize).copied());
                picked.collect::<Option<Vec<_>>>().map_or(Value::Other, Value::Numbers)
            }
            // No list (of precipitation, blocks of bits, stars) is longer.
            E::ArrayLength(_) => Value::scalar(Range::new(1.0, 16_777_216.0)),
            E::ImageQuery { query, .. } => match query {
                ImageQuery::Size { .. } => Value::Numbers(vec![Range::new(1.0, 65536.0); 3]),
                ImageQuery::NumSamples | ImageQuery::NumLevels => Value::scalar(Range::new(1.0, 32.0)),
                ImageQuery::NumLayers => Value::scalar(Range::new(1.0, 2048.0)),
            },
            E::Unary { op: UnaryOperator::Negate, expr } => each(of(expr), Range::negate),
            E::Binary { op, left, right } => {
                let is_same = same(function, *left, *right);
                binary(*op, of(left), of(right), is_same)
            }
            E::Select { accept, reject, .. } => of(accept).join(of(reject)),
            E::Math { fun, arg, arg1, arg2, .. } => {
                let is_same = arg1.is_some_and(|other| same(function, *arg, other));
                math(*fun, of(arg), arg1.as_ref().map(of), arg2.as_ref().map(of), is_same)
            }
            E::As { expr, kind, convert: Some(_) } => {
                let bounds = match kind {
                    ScalarKind::Uint => Range::U32,
                    ScalarKind::Sint => Range::I32,
                    ScalarKind::Bool => Range::SHARE,
                    _ => Range::ALL,
                };
                let whole = |v: f64| if matches!(kind, ScalarKind::Uint | ScalarKind::Sint) { v.trunc() } else { v };
                each(of(expr), |r| r.rising(|v| whole(v).clamp(bounds.lo, bounds.hi)))
            }
            _ => Value::Other,
        }
    }
}

/// Whether two expressions are the same part of the same value.
pub fn same(function: &Function, a: Handle<naga::Expression>, b: Handle<naga::Expression>) -> bool {
    if a == b {
        return true;
    }
    match (&function.expressions[a], &function.expressions[b]) {
        (E::Load { pointer: a }, E::Load { pointer: b }) => same(function, *a, *b),
        (E::AccessIndex { base: a, index: i }, E::AccessIndex { base: b, index: j }) => {
            i == j && same(function, *a, *b)
        }
        (E::Access { base: a, index: i }, E::Access { base: b, index: j }) => {
            same(function, *i, *j) && same(function, *a, *b)
        }
        (E::Swizzle { vector: a, pattern: p, size: s }, E::Swizzle { vector: b, pattern: q, size: t }) => {
            s == t && p == q && same(function, *a, *b)
        }
        (a, b) => a == b && !matches!(a, E::CallResult(_)),
    }
}

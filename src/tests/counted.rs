//! The work of a GPU for a frame, counted without a GPU: passes, bytes of a view for each pixel, and for each draw of
//! the composition the greatest numbers of texels and operations of a pixel. The test compares the counts with the
//! table of docs/lab/counts.md.
//!
//! The counts are static. Each shader is parsed by naga with the constants of a GPU's pipelines. Where a constant
//! decides a branch, the side that is taken counts; elsewhere the dearer side does. The body of a loop counts once. The
//! driver assigns registers, so they are not counted.

use std::{collections::HashMap, sync::Arc};

use glam::{DMat4, DVec3};
use wgpu::naga::{
    Block, Expression, Function, Handle, Literal, LocalVariable, Module, ScalarKind, Statement, TypeInner,
    UnaryOperator, front::wgsl, valid,
};

use crate::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, flat_texture, shader},
    scene::Camera,
    stage::Constants,
    weather::Weather,
};

/// Numbers of texels read and of operations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Count {
    texels: u32,
    operations: u32,
}

impl Count {
    fn plus(self, other: Self) -> Self {
        Self { texels: self.texels + other.texels, operations: self.operations + other.operations }
    }

    fn most(self, other: Self) -> Self {
        Self { texels: self.texels.max(other.texels), operations: self.operations.max(other.operations) }
    }
}

/// Greatest count over all ways through some statements, and whether every way leaves the block there (return, break,
/// continue, discard).
#[derive(Clone, Copy, Default)]
struct Way {
    count: Count,
    ends: bool,
}

/// A shader with the values of its constants written in, and the counts of its functions so far.
struct Counted {
    module: Module,
    info: valid::ModuleInfo,
    functions: HashMap<Handle<Function>, Count>,
}

impl Counted {
    fn new(text: &str, constants: &[(&str, f64)]) -> Self {
        let text: String = text.lines().map(|line| decided(line, constants) + "\n").collect();
        let module = wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
        let mut validator = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::all());
        let info = validator.validate(&module).expect("a valid shader");
        Self { module, info, functions: HashMap::new() }
    }

    fn entry(&mut self, name: &str) -> Count {
        let at = self.module.entry_points.iter().position(|e| e.name == name).expect("an entry point");
        let function = self.module.entry_points[at].function.clone();
        let known = Known::new(&function, self.info.get_entry_point(at), &self.module);
        self.block(&function, &known, &function.body).count
    }

    fn function(&mut self, handle: Handle<Function>) -> Count {
        if let Some(known) = self.functions.get(&handle) {
            return *known;
        }
        let function = self.module.functions[handle].clone();
        let known = Known::new(&function, &self.info[handle], &self.module);
        let count = self.block(&function, &known, &function.body).count;
        self.functions.insert(handle, count);
        count
    }

    fn block(&mut self, function: &Function, known: &Known, block: &Block) -> Way {
        // Goes from the last statement to the first, because the statements after a branch that ends are not on its
        // way.
        block.iter().rev().fold(Way::default(), |rest, statement| {
            let here = |count: Count| Way { count: count.plus(rest.count), ends: rest.ends };
            let joined = |way: Way| if way.ends { way } else { here(way.count) };
            match statement {
                Statement::Emit(range) => {
                    here(range.clone().fold(Count::default(), |sum, e| {
                        sum.plus(work(&function.expressions[e], known.sizes[e.index()]))
                    }))
                }
                Statement::Block(inner) => joined(self.block(function, known, inner)),
                Statement::If { condition, accept, reject } => {
                    let ways = [accept, reject].map(|b| joined(self.block(function, known, b)));
                    match known.values.get(condition).copied() {
                        Some(true) => ways[0],
                        Some(false) => ways[1],
                        None => Way { count: ways[0].count.most(ways[1].count), ends: ways[0].ends && ways[1].ends },
                    }
                }
                Statement::Switch { cases, .. } => {
                    let ways = cases.iter().map(|c| joined(self.block(function, known, &c.body)));
                    Way { count: ways.fold(Count::default(), |most, way| most.most(way.count)), ends: false }
                }
                Statement::Loop { body, continuing, .. } => {
                    let turn = self.block(function, known, body).count;
                    here(turn.plus(self.block(function, known, continuing).count))
                }
                Statement::Call { function: called, .. } => here(self.function(*called)),
                Statement::Return { .. } | Statement::Break | Statement::Continue | Statement::Kill => {
                    Way { count: Count::default(), ends: true }
                }
                _ => rest,
            }
        })
    }
}

/// Properties of a function's expressions.
struct Known {
    /// Number of components of each expression.
    sizes: Vec<u32>,
    /// Values of the conditions that constants decide.
    values: HashMap<Handle<Expression>, bool>,
}

impl Known {
    fn new(function: &Function, info: &valid::FunctionInfo, module: &Module) -> Self {
        let sizes = function.expressions.iter().map(|(e, _)| size(&info[e].ty, module)).collect();
        let mut known = Self { sizes, values: HashMap::new() };
        for (e, expression) in function.expressions.iter() {
            let literal = match expression {
                Expression::Constant(constant) => &module.global_expressions[module.constants[*constant].init],
                own => own,
            };
            if let Expression::Literal(Literal::Bool(value)) = literal {
                known.values.insert(e, *value);
            }
        }
        known.walk(function, &function.body, &mut HashMap::new());
        known
    }

    /// Finds the conditions that constants decide in some statements. `held` has the variables whose values are known:
    /// `a && b` becomes a branch that writes a variable.
    fn walk(&mut self, function: &Function, block: &Block, held: &mut HashMap<Handle<LocalVariable>, bool>) {
        let local = |pointer: Handle<Expression>| match function.expressions[pointer] {
            Expression::LocalVariable(variable) => Some(variable),
            _ => None,
        };
        for statement in block.iter() {
            match statement {
                Statement::Emit(range) => range.clone().for_each(|e| {
                    let value = match function.expressions[e] {
                        Expression::Load { pointer } => local(pointer).and_then(|v| held.get(&v).copied()),
                        Expression::Unary { op: UnaryOperator::LogicalNot, expr } => self.values.get(&expr).map(|v| !v),
                        _ => None,
                    };
                    self.values.extend(value.map(|value| (e, value)));
                }),
                Statement::Store { pointer, value } => {
                    if let Some(variable) = local(*pointer) {
                        held.remove(&variable);
                        held.extend(self.values.get(value).map(|value| (variable, *value)));
                    }
                }
                Statement::Block(inner) => self.walk(function, inner, held),
                Statement::If { condition, accept, reject } => match self.values.get(condition) {
                    Some(true) => self.walk(function, accept, held),
                    Some(false) => self.walk(function, reject, held),
                    None => {
                        let mut other = held.clone();
                        self.walk(function, accept, held);
                        self.walk(function, reject, &mut other);
                        held.retain(|variable, value| other.get(variable) == Some(value));
                    }
                },
                Statement::Loop { body, continuing, .. } => {
                    // Values that one turn of a loop writes are unknown in the next.
                    held.clear();
                    self.walk(function, body, held);
                    self.walk(function, continuing, held);
                    held.clear();
                }
                Statement::Switch { cases, .. } => {
                    cases.iter().for_each(|case| self.walk(function, &case.body, &mut held.clone()));
                    held.clear();
                }
                _ => {}
            }
        }
    }
}

/// Returns a line of a shader with the value of its override constant written in.
fn decided(line: &str, constants: &[(&str, f64)]) -> String {
    let Some((name, rest)) = line.strip_prefix("override ").and_then(|rest| rest.split_once(':')) else {
        return line.to_owned();
    };
    let Some((_, value)) = constants.iter().find(|(known, _)| *known == name) else {
        return format!("const {name}:{rest}");
    };
    let ty = rest.split(['=', ';']).next().unwrap_or_default().trim();
    let value = match ty {
        "bool" => (*value != 0.0).to_string(),
        "u32" => format!("{value}u"),
        _ => format!("{value:?}"),
    };
    format!("const {name}: {ty} = {value};")
}

/// Number of components of a value.
fn size(ty: &wgpu::naga::proc::TypeResolution, module: &Module) -> u32 {
    match ty.inner_with(&module.types) {
        TypeInner::Scalar(scalar) if scalar.kind != ScalarKind::Bool => 1,
        TypeInner::Vector { size, scalar } if scalar.kind != ScalarKind::Bool => *size as u32,
        TypeInner::Matrix { columns, rows, .. } => *columns as u32 * *rows as u32,
        _ => 1,
    }
}

fn work(expression: &Expression, size: u32) -> Count {
    use Expression as E;
    match expression {
        E::ImageSample { .. } | E::ImageLoad { .. } => Count { texels: 1, operations: 1 },
        E::Binary { .. } | E::Unary { .. } | E::Math { .. } | E::Select { .. } | E::As { .. } => {
            Count { texels: 0, operations: size }
        }
        E::Relational { .. } | E::Derivative { .. } | E::ImageQuery { .. } => Count { texels: 0, operations: 1 },
        _ => Count::default(),
    }
}

/// Counts of a weather's frames.
struct Counts {
    passes: u32,
    bytes_a_pixel: f64,
    draws: Vec<(String, Count)>,
}

/// A view and its world.
struct Host {
    device: Arc<Device>,
    context: Context,
    view: View,
}

impl Host {
    fn new(weather: &str) -> Self {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let mut device = Device::headless(&options).expect("a device that draws nothing");
        Arc::get_mut(&mut device).expect("its only owner").take_for_gpu();
        let shared = Arc::new(Shared::new(&device).expect("shared"));
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).expect("a context");
        context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 50.0 })).expect("a sun");
        context.set_weather(&Weather::preset(weather).expect("a preset"), 0.0, 0.0).expect("weather");
        context.update(0.0).expect("a time");
        let view = View::new(&context).expect("a view");
        Self { device, context, view }
    }

    /// Draws until nothing is built any more; returns the greatest number of passes among the last 32 frames, since
    /// some work alternates between frames.
    fn draw(&mut self, size: (u32, u32)) -> u32 {
        use wgpu::TextureUsages as U;
        let seen = U::TEXTURE_BINDING | U::RENDER_ATTACHMENT;
        let texture = |format, usage| flat_texture(&self.device.device, "host", size, format, usage);
        let color = texture(wgpu::TextureFormat::Rgba16Float, seen | U::COPY_SRC | U::COPY_DST);
        let depth = texture(wgpu::TextureFormat::Depth32Float, seen);
        let mut camera = Camera::look_to(DVec3::Z * 2.0, DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
        let mut passes = Vec::new();
        for _ in 0..400 {
            camera.view *= DMat4::from_rotation_z(0.01);
            let id = self.view.report().frame_id.wrapping_add(1);
            let frame = Frame::new(id, camera, &color, Some(&depth));
            self.view.record(&self.context, &frame, Stages::ALL).expect("a frame");
            passes.push(self.view.report().passes);
        }
        passes.split_off(368).into_iter().max().unwrap_or(0)
    }
}

fn counts(weather: &str) -> Counts {
    let mut host = Host::new(weather);
    host.draw((640, 360));
    let small = host.view.report().bytes;
    let passes = host.draw((1280, 720));
    let bytes = host.view.report().bytes - small;
    let bytes_a_pixel = bytes as f64 / f64::from(1280 * 720 - 640 * 360);
    let count = |(pixels, (name, entry), constants): (String, (String, &str), Constants)| {
        let text = shader::assemble(&name).expect("a shader");
        (pixels, Counted::new(&text, constants.all()).entry(entry))
    };
    let draws = host.view.composes_with().into_iter().map(count).collect();
    Counts { passes, bytes_a_pixel, draws }
}

/// Texels and operations of the most expensive pixel that is drawn in full in a weather.
pub(super) fn dearest_pixel(weather: &str) -> [u32; 2] {
    let drawn = counts(weather).draws.into_iter().filter(|(pixels, _)| pixels == "Uneven");
    let most = drawn.fold(Count::default(), |most, (_, count)| most.most(count));
    [most.texels, most.operations]
}

/// Meaning of a pixel of each draw, in the order of the table.
const DRAWS: [(&str, &str); 4] = [
    ("Uneven", "drawn whole"),
    ("Grid", "a texel of the grid"),
    ("Even", "looked up"),
    ("EvenDrawn", "looked up, with what lies on it or hangs before it"),
];

/// Text of the table in docs/lab/counts.md.
fn table() -> String {
    let mut text = String::from(
        "| weather | passes | bytes a pixel | a pixel | texels | operations |\n|---|---|---|---|---|---|\n",
    );
    for weather in ["clear", "fog", "rain", "snow", "broken"] {
        let Counts { passes, bytes_a_pixel, draws } = counts(weather);
        let mut first = format!("| {weather} | {passes} | {bytes_a_pixel:.1} ");
        for (pixels, what) in DRAWS {
            for (_, Count { texels, operations }) in draws.iter().filter(|draw| draw.0 == pixels) {
                text += &format!("{first}| {what} | {texels} | {operations} |\n");
                first = "| | | ".into();
            }
        }
    }
    text
}

#[test]
fn a_gpus_frame_has_the_counts_of_the_table() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/lab/counts.md");
    let (page, found) = (std::fs::read_to_string(&path).expect("the page"), table());
    let begin = page.find("| weather |").expect("the page has a table");
    let end = begin + page[begin..].find("\n\n").map_or(page.len() - begin, |at| at + 1);
    if std::env::var_os("WELKIN_BLESS").is_some() {
        std::fs::write(&path, [&page[..begin], &found, &page[end..]].concat()).expect("the page can be written");
    } else {
        assert_eq!(&page[begin..end], found, "WELKIN_BLESS=1 writes the page anew");
    }
}

#[test]
fn the_count_skips_branches_that_constants_rule_out() {
    let text = "@group(0) @binding(0) var t: texture_2d<f32>;
        override ON: bool = false;
        override ALSO: bool = true;
        fn load(i: i32) -> f32 { return textureLoad(t, vec2i(i), 0).r; }
        @fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
            var sum = at.x * 2.0;
            if ON && ALSO && at.x > 1.0 { sum += load(1) + load(2); }
            if at.y > 3.0 { return vec4f(load(3)); }
            return vec4f(sum + load(4) + load(5));
        }";
    let text = text.replace("        override", "override");
    let of = |constants: &[(&str, f64)]| Counted::new(&text, constants).entry("main").texels;
    assert_eq!([of(&[]), of(&[("ON", 1.0)]), of(&[("ON", 1.0), ("ALSO", 0.0)])], [2, 4, 2]);
}

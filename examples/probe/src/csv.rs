//! Questions as CSV with a header. Other columns are allowed, in any order. Each line is returned with its answer
//! appended. Blank lines are left out.

use std::fmt::Display;

use welkin::{Error, Result, Status};

/// A column of numbers.
#[derive(Clone, Copy)]
pub struct Column {
    name: &'static str,
    low: f64,
    high: f64,
    unit: &'static str,
    /// Value if the column is missing.
    default: Option<f64>,
}

impl Column {
    /// Numbers in `[low, high]`; `unit` may be empty.
    pub const fn new(name: &'static str, [low, high]: [f64; 2], unit: &'static str) -> Self {
        Self { name, low, high, unit, default: None }
    }

    /// As this column, but optional.
    pub const fn or(self, default: f64) -> Self {
        Self { default: Some(default), ..self }
    }

    fn number(&self, field: &Field) -> Result<f64> {
        let Self { name, low, high, unit, .. } = self;
        let text = field.text.trim();
        let found = text.parse::<f64>().ok().filter(|v| (low..=high).contains(&v));
        let gap = if unit.is_empty() { "" } else { " " };
        found.ok_or_else(|| field.fault(format!("{name} must be a number in [{low}, {high}]{gap}{unit}, got {text:?}")))
    }
}

/// The text with all questions.
pub struct Table<'a> {
    header: &'a str,
    header_line: usize,
    names: Vec<&'a str>,
    /// The rows with questions, in order.
    pub rows: Vec<Row<'a>>,
}

/// One question.
pub struct Row<'a> {
    /// The original line.
    pub line: &'a str,
    number: usize,
}

/// The value of a column in a row.
pub struct Field<'a> {
    /// The text, with the blanks around it.
    pub text: &'a str,
    line: usize,
    column: usize,
}

/// An error at a line and column. Both count from 0 here and from 1 in the message; columns are characters.
fn fault(line: usize, column: usize, what: impl Display) -> Error {
    Error::new(Status::Parse, format!("line {}, column {}: {what}", line + 1, column + 1))
}

impl Field<'_> {
    /// An error in this field.
    pub fn fault(&self, what: impl Display) -> Error {
        fault(self.line, self.column, what)
    }
}

impl<'a> Row<'a> {
    /// An error in this row as a whole.
    pub fn fault(&self, what: impl Display) -> Error {
        fault(self.number, 0, what)
    }

    /// All its fields.
    pub fn fields(&self) -> Vec<Field<'a>> {
        let mut column = 0;
        let field = |text: &'a str| {
            let at = column;
            column += text.chars().count() + 1;
            Field { text, line: self.number, column: at }
        };
        self.line.split(',').map(field).collect()
    }
}

impl<'a> Table<'a> {
    /// Reads the rows of a text; `wanted` lists the columns that its header should have.
    ///
    /// # Errors
    /// [`Status::Parse`] for a text without a header.
    pub fn read(text: &'a str, wanted: &str) -> Result<Self> {
        let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
        let (header_line, header) =
            lines.next().ok_or_else(|| fault(0, 0, format!("a header with {wanted} is missing")))?;
        let names = header.split(',').map(str::trim).collect();
        Ok(Self { header, header_line, names, rows: lines.map(|(number, line)| Row { line, number }).collect() })
    }

    /// Position of a column.
    ///
    /// # Errors
    /// [`Status::Parse`] if no column has that name.
    pub fn place(&self, name: &str) -> Result<usize> {
        let found = self.names.iter().position(|n| *n == name);
        found.ok_or_else(|| fault(self.header_line, 0, format!("no column {name} among {:?}", self.names)))
    }

    /// The fields of a row, as many as the header has.
    ///
    /// # Errors
    /// [`Status::Parse`] if the row has more or fewer fields.
    pub fn fields(&self, row: &Row<'a>) -> Result<Vec<Field<'a>>> {
        let (fields, wanted) = (row.fields(), self.names.len());
        if fields.len() == wanted {
            return Ok(fields);
        }
        let what = format!("{} fields, the header has {wanted}", fields.len());
        Err(fault(row.number, row.line.chars().count(), what))
    }

    /// The numbers of each row, in the order of `columns`; 0 beyond them.
    ///
    /// # Errors
    /// [`Status::Parse`] for a missing column, and for a value that is not a number in its range.
    pub fn numbers<const N: usize>(&self, columns: &[Column]) -> Result<Vec<[f64; N]>> {
        let place = |c: &Column| match (self.place(c.name), c.default) {
            (Err(_), Some(_)) => Ok(None),
            (found, _) => found.map(Some),
        };
        let places = columns.iter().map(place).collect::<Result<Vec<_>>>()?;
        let of_row = |row: &Row<'a>| {
            let fields = self.fields(row)?;
            let mut numbers = [0.0; N];
            for ((number, column), place) in numbers.iter_mut().zip(columns).zip(&places) {
                *number = match place {
                    Some(place) => column.number(&fields[*place])?,
                    None => column.default.unwrap_or(0.0),
                };
            }
            Ok(numbers)
        };
        self.rows.iter().map(of_row).collect()
    }

    /// The text with the columns `added`, which hold the answers, one per row.
    pub fn answered(&self, added: &str, answers: impl IntoIterator<Item = String>) -> String {
        let mut out = format!("{},{added}\n", self.header);
        for (row, answer) in self.rows.iter().zip(answers) {
            out.extend([row.line, ",", &answer, "\n"]);
        }
        out
    }
}

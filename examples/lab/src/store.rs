//! Results as CSV. Each row is appended as soon as it is measured, so that a stopped run loses nothing.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use welkin::{Error, Result, Status};

/// A CSV file: lines that begin with `#`, a header, rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The first line without its `# `: the quantity, the program and the machine.
    pub note: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows as wide as the header.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a file; `None` if there is none. An incomplete last line is ignored.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path) -> Result<Option<Self>> {
        if !path.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(path).map_err(|e| io(path, &e))?;
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut table = Self::default();
        for line in whole.lines() {
            if let Some(note) = line.strip_prefix("# ") {
                table.note = note.to_owned();
            } else if table.columns.is_empty() {
                table.columns = line.split(',').map(str::to_owned).collect();
            } else {
                let row: Vec<String> = line.split(',').map(str::to_owned).collect();
                if row.len() == table.columns.len() {
                    table.rows.push(row);
                }
            }
        }
        Ok(Some(table))
    }

    /// The row whose first field is `key`.
    pub fn row(&self, key: &str) -> Option<&[String]> {
        self.rows.iter().find(|r| r[0] == key).map(Vec::as_slice)
    }

    /// A number in a row, by the name of its column.
    pub fn number(&self, row: &[String], column: &str) -> Option<f64> {
        let i = self.columns.iter().position(|c| c == column)?;
        row.get(i)?.parse().ok()
    }
}

/// A table that grows on disk as `NAME.csv.part` and becomes `NAME.csv` when it is complete.
pub struct Journal {
    path: PathBuf,
    part: PathBuf,
    table: Table,
}

impl Journal {
    /// Continues an interrupted run with the same note and columns, or starts a new file.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub fn open(directory: &Path, name: &str, note: &str, columns: &[&str], fresh: bool) -> Result<Self> {
        fs::create_dir_all(directory).map_err(|e| io(directory, &e))?;
        let path = directory.join(format!("{name}.csv"));
        let part = directory.join(format!("{name}.csv.part"));
        let columns: Vec<String> = columns.iter().map(|c| (*c).to_owned()).collect();
        let old = if fresh { None } else { Table::read(&part)? };
        let table = old.filter(|t| t.note == note && t.columns == columns);
        let table = table.unwrap_or(Table { note: note.to_owned(), columns, rows: Vec::new() });
        let this = Self { path, part, table };
        // Written again, so that an incomplete line is removed.
        fs::write(&this.part, this.text()).map_err(|e| io(&this.part, &e))?;
        Ok(this)
    }

    fn text(&self) -> String {
        let mut out = format!("# {}\n{}\n", self.table.note, self.table.columns.join(","));
        self.table.rows.iter().for_each(|r| out.push_str(&(r.join(",") + "\n")));
        out
    }

    /// Whether a row with `key` as its first field exists.
    pub fn has(&self, key: &str) -> bool {
        self.table.row(key).is_some()
    }

    /// Appends a row. It is on disk when this returns.
    ///
    /// # Errors
    /// A row of the wrong width; a file that cannot be written.
    pub fn push(&mut self, row: Vec<String>) -> Result<()> {
        if row.len() != self.table.columns.len() {
            let what = format!("a row of {} fields under {} columns", row.len(), self.table.columns.len());
            return Err(Error::new(Status::Internal, what));
        }
        let mut file = fs::OpenOptions::new().append(true).open(&self.part).map_err(|e| io(&self.part, &e))?;
        file.write_all((row.join(",") + "\n").as_bytes()).map_err(|e| io(&self.part, &e))?;
        self.table.rows.push(row);
        Ok(())
    }

    /// Moves the finished table to its final name. Returns it and the previous one.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub fn finish(self) -> Result<(Table, Option<Table>)> {
        let old = Table::read(&self.path)?;
        fs::rename(&self.part, &self.path).map_err(|e| io(&self.part, &e))?;
        Ok((self.table, old))
    }
}

/// Converts a file error.
pub fn io(path: &Path, e: &dyn std::fmt::Display) -> Error {
    Error::new(Status::Io, format!("{}: {e}", path.display()))
}

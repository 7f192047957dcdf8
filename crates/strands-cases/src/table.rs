//! The reference figures, as tables that are compiled in: `#` lines say the source, then a line of column names, then rows.
//!
//! A missing column or a cell that is no number is a mistake in this crate, not in a user's input, so it panics with its place; a
//! test reads every case.

use strands::math::{Quat, Vec3};

/// A table.
pub(crate) struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

/// A row of a table.
pub(crate) struct Record<'t> {
    table: &'t Table,
    row: usize,
}

impl Table {
    pub fn read(text: &'static str) -> Self {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let columns = lines.next().unwrap_or_default().split(',').collect();
        let rows = lines.map(|line| line.split(',').collect()).collect();
        Self { columns, rows }
    }

    pub fn records(&self) -> impl Iterator<Item = Record<'_>> {
        (0..self.rows.len()).map(|row| Record { table: self, row })
    }
}

impl Record<'_> {
    pub fn text(&self, column: &str) -> &'static str {
        let place = self.table.columns.iter().position(|name| *name == column);
        let cell = place.and_then(|place| self.table.rows[self.row].get(place));
        cell.unwrap_or_else(|| panic!("row {} has no {column}", self.row))
    }

    pub fn number(&self, column: &str) -> f64 {
        let cell = self.text(column);
        cell.parse().unwrap_or_else(|_| panic!("row {}, {column}: {cell:?} is not a number", self.row))
    }

    /// A number, or nothing where the cell is empty.
    pub fn figure(&self, column: &str) -> Option<f64> {
        (!self.text(column).is_empty()).then(|| self.number(column))
    }

    /// A whole number, or nothing where the cell is empty.
    pub fn count(&self, column: &str) -> Option<usize> {
        let cell = self.text(column);
        let not_whole = |_| panic!("row {}, {column}: {cell:?} is not a whole number", self.row);
        (!cell.is_empty()).then(|| cell.parse().unwrap_or_else(not_whole))
    }

    /// The columns `prefix` followed by x, y and z.
    pub fn vector(&self, prefix: &str) -> Vec3 {
        let [x, y, z] = ["x", "y", "z"].map(|axis| self.number(&format!("{prefix}{axis}")));
        Vec3::new(x, y, z)
    }

    /// The columns `prefix` followed by w, x, y and z.
    pub fn quaternion(&self, prefix: &str) -> Quat {
        let wxyz = ["w", "x", "y", "z"].map(|axis| self.number(&format!("{prefix}{axis}")));
        Quat::from_wxyz(wxyz).unwrap_or_else(|| panic!("row {}, {prefix}: not an orientation", self.row))
    }
}

//! SQLite's file format (<https://www.sqlite.org/fileformat2.html>), as far as reading whole tables needs it.

use opendr_engine::{Error, Result};

use crate::storage::sqlite::columns::columns_from_sql;
use crate::storage::sqlite::record::{Cell, cells_from_record, varint};

const MAGIC: &[u8] = b"SQLite format 3\0";
const HEADER: usize = 100;
const LEAF: u8 = 13;
const INTERIOR: u8 = 5;
/// Maximum depth of a tree; deeper ones exceed any disk.
const MAX_DEPTH: usize = 20;

/// A database in memory.
pub struct Database<'a> {
    bytes: &'a [u8],
    page_size: usize,
    /// Usable bytes of a page.
    usable: usize,
}

/// Remaining pages and bytes of a tree: each page at most once, no more bytes than the file has. It ends cycles.
struct Allowance {
    pages: usize,
    bytes: usize,
}

/// A table with all its rows.
pub struct Table {
    name: String,
    columns: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

/// One row.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    table: &'a Table,
    cells: &'a [Cell],
}

impl<'a> Database<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Self> {
        if !bytes.starts_with(MAGIC) || bytes.len() < HEADER {
            return Err(Error::format("the file is not a SQLite database"));
        }
        let page_size = match u16::from_be_bytes([bytes[16], bytes[17]]) {
            1 => 65_536,
            size => usize::from(size),
        };
        let usable = page_size.checked_sub(usize::from(bytes[20])).filter(|usable| *usable >= 480);
        let (Some(usable), true) = (usable, page_size.is_power_of_two()) else {
            return Err(damaged("the size of its pages"));
        };
        // 0 before there are tables.
        if !matches!(bytes[59], 0 | 1) || bytes[56..59] != [0; 3] {
            return Err(Error::unsupported("its text encoding is UTF-16; Optuna writes UTF-8"));
        }
        Ok(Self { bytes, page_size, usable })
    }

    /// Returns the table `name`.
    pub fn table(&self, name: &str) -> Result<Table> {
        let schema = Table { name: "sqlite_schema".to_owned(), columns: Vec::new(), rows: self.rows(1)? };
        let found = schema.rows.iter().find_map(|row| match row.as_slice() {
            [Cell::Text(kind), Cell::Text(found), _, Cell::Int(page), Cell::Text(sql)]
                if kind == "table" && found == name =>
            {
                Some((usize::try_from(*page).ok()?, sql))
            }
            _ => None,
        });
        let (page, sql) = found.ok_or_else(|| {
            Error::format(format!("the database has no table {name:?}; it is not one of Optuna's"))
        })?;
        let columns = columns_from_sql(sql).ok_or_else(|| damaged(&format!("the definition of {name:?}")))?;
        Ok(Table { name: name.to_owned(), columns, rows: self.rows(page)? })
    }

    fn rows(&self, root: usize) -> Result<Vec<Vec<Cell>>> {
        let mut rows = Vec::new();
        let mut left = Allowance { pages: self.bytes.len() / self.page_size, bytes: self.bytes.len() };
        self.walk(root, 0, &mut left, &mut rows)?;
        Ok(rows)
    }

    /// Appends the rows below a page.
    fn walk(
        &self,
        number: usize,
        depth: usize,
        left: &mut Allowance,
        rows: &mut Vec<Vec<Cell>>,
    ) -> Result<()> {
        left.pages =
            left.pages.checked_sub(1).filter(|_| depth < MAX_DEPTH).ok_or_else(|| damaged("a tree"))?;
        let page = self.page(number)?;
        let header = page.get(if number == 1 { HEADER } else { 0 }..).unwrap_or_default();
        let &[kind, _, _, count_high, count_low, ..] = header else { return Err(damaged("a page")) };
        let count = usize::from(u16::from_be_bytes([count_high, count_low]));
        let pointers = header.get(if kind == INTERIOR { 12 } else { 8 }..).unwrap_or_default();
        for pointer in pointers.chunks_exact(2).take(count) {
            let cell =
                page.get(usize::from(u16::from_be_bytes([pointer[0], pointer[1]]))..).unwrap_or_default();
            match kind {
                LEAF => rows.push(self.row(cell, left)?),
                INTERIOR => self.walk(page_number(cell)?, depth + 1, left, rows)?,
                _ => return Err(damaged("a page of a table")),
            }
        }
        match kind {
            LEAF => Ok(()),
            INTERIOR => self.walk(page_number(header.get(8..).unwrap_or_default())?, depth + 1, left, rows),
            _ => Err(damaged("a page of a table")),
        }
    }

    fn row(&self, cell: &[u8], left: &mut Allowance) -> Result<Vec<Cell>> {
        let (length, cell) = varint(cell).ok_or_else(|| damaged("a cell"))?;
        let (key, cell) = varint(cell).ok_or_else(|| damaged("a cell"))?;
        let length = usize::try_from(length).ok().filter(|length| (1..=left.bytes).contains(length));
        let length = length.ok_or_else(|| damaged("the length of a row"))?;
        left.bytes -= length;
        let local = self.local(length);
        let mut payload = cell.get(..local).ok_or_else(|| damaged("a cell"))?.to_vec();
        let mut rest = cell.get(local..).unwrap_or_default();
        while payload.len() < length {
            let page = self.page(page_number(rest)?)?;
            let part = page.get(4..self.usable.min(4 + length - payload.len())).unwrap_or_default();
            payload.extend_from_slice(part);
            rest = page;
        }
        cells_from_record(&payload, key).ok_or_else(|| damaged("a row"))
    }

    /// Returns how many bytes of a row of `length` bytes are stored in the tree page itself.
    fn local(&self, length: usize) -> usize {
        let (most, least) = (self.usable - 35, (self.usable - 12) * 32 / 255 - 23);
        if length <= most {
            return length;
        }
        let filled = least + (length - least) % (self.usable - 4);
        if filled <= most { filled } else { least }
    }

    fn page(&self, number: usize) -> Result<&'a [u8]> {
        let start = number.checked_sub(1).and_then(|at| at.checked_mul(self.page_size));
        let page = start.and_then(|start| self.bytes.get(start..start.checked_add(self.page_size)?));
        page.ok_or_else(|| damaged(&format!("page {number}, which is beyond its end")))
    }
}

impl Table {
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }
}

impl<'a> Row<'a> {
    fn cell(self, column: &str) -> Result<&'a Cell> {
        let at = self.table.columns.iter().position(|known| known == column);
        let at =
            at.ok_or_else(|| Error::format(format!("table {} has no column {column:?}", self.table.name)))?;
        // A column that was added later is missing in older rows.
        Ok(self.cells.get(at).unwrap_or(&Cell::Null))
    }

    fn wrong(self, column: &str, what: &str) -> Error {
        Error::format(format!("{}.{column} is not a {what}", self.table.name))
    }

    pub fn int(self, column: &str) -> Result<i64> {
        match self.cell(column)? {
            Cell::Int(number) => Ok(*number),
            _ => Err(self.wrong(column, "whole number")),
        }
    }

    pub fn number(self, column: &str) -> Result<f64> {
        match self.cell(column)? {
            // SQLite writes 3.0 as 3.
            Cell::Int(number) => Ok(*number as f64),
            Cell::Real(number) => Ok(*number),
            _ => Err(self.wrong(column, "number")),
        }
    }

    pub fn text(self, column: &str) -> Result<&'a str> {
        self.optional_text(column)?.ok_or_else(|| self.wrong(column, "string"))
    }

    pub fn optional_text(self, column: &str) -> Result<Option<&'a str>> {
        match self.cell(column)? {
            Cell::Null => Ok(None),
            Cell::Text(text) => Ok(Some(text)),
            _ => Err(self.wrong(column, "string")),
        }
    }
}

fn page_number(bytes: &[u8]) -> Result<usize> {
    let number = bytes.first_chunk().map(|number| u32::from_be_bytes(*number));
    number.and_then(|number| usize::try_from(number).ok()).ok_or_else(|| damaged("a cell"))
}

fn damaged(what: &str) -> Error {
    Error::format(format!("the database is damaged: {what}"))
}

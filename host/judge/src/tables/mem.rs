//! Memory images for Verilog's `$readmemh`: NAME.steps.mem and NAME.kernel.mem.
//!
//! A row factor, or an entry of a grid, is a word of 25 bits, written as 7 hexadecimal digits. A node is a word of 80 bits, 20
//! digits: g6 r5 g4 r1 g0, 16 bits each in two's complement, g6 the most significant, as the core takes it. Comments at the top
//! say so, and give the geometry that [`read`] needs.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use halfrow_model::{BitDepth, Geometry, GridShape, Kernel, TableSet, WEIGHT_NAMES};
use halfrow_protocol::message::Datapath;

use super::{DATAPATH, MemError, Place, TableFileError, TableFormat, WrongDatapath, datapath_of};
use crate::call::Input;
use halfrow_files::text::{self, quoted};
use halfrow_files::written_aside::{Aside, Claim, WriteAsideError, put_all_in_place};

/// Hexadecimal digits of a row factor, and of an entry of a grid.
const ENTRY_DIGITS: usize = 7;

/// Hexadecimal digits of a weight.
const WEIGHT_DIGITS: usize = 4;

/// Hexadecimal digits of a node.
const NODE_DIGITS: usize = WEIGHT_DIGITS * WEIGHT_NAMES.len();

/// How the comments give the order of the weights, from the most significant. An image in another order would be taken for
/// another kernel.
const WEIGHT_ORDER: &str = "order=g6,r5,g4,r1,g0";

/// The parts of the two files' names that tell them apart.
const PARTS: [&str; 2] = ["steps", "kernel"];

/// The two files meant by `path`: NAME.steps.mem and NAME.kernel.mem for NAME.mem or NAME.
#[must_use]
pub fn paths(path: &Path) -> [PathBuf; 2] {
    let name = if is_name(path) { path.with_extension("") } else { path.to_owned() };
    PARTS.map(|part| {
        let mut file = name.clone().into_os_string();
        file.push(format!(".{part}.mem"));
        file.into()
    })
}

/// Whether `path` ends in `.mem`.
pub(super) fn is_name(path: &Path) -> bool {
    TableFormat::of(path) == Ok(TableFormat::Mem)
}

/// The name that both files share if `path` looks like the name of one of them; but `path` itself if that is what both files
/// there share.
fn name_of_both(path: &Path) -> PathBuf {
    let name = path.with_extension("");
    let is_one = is_name(path) && PARTS.iter().any(|part| name.extension().is_some_and(|it| it == *part));
    let is_shared = || !path.exists() && paths(path).iter().any(|file| file.exists());
    if is_one && !is_shared() { name.with_extension("") } else { path.to_owned() }
}

/// Writes both files for `path`, named by [`paths`], and returns their names. Neither is put in place before both are
/// written, and if one is refused its place, the other is as before.
///
/// # Errors
/// [`WriteAsideError`] when one of them exists and `overwrite` is false, or cannot be written.
pub fn write(
    path: &Path,
    tables: &TableSet,
    kernel: &Kernel,
    overwrite: bool,
) -> Result<Vec<PathBuf>, WriteAsideError> {
    let [rows, nodes] = paths(path);
    // So that two runs that overwrite each other leave both files of one run, not one file of each.
    let _turn = Claim::wait(path)?;
    let written = [
        Aside::written(&rows, overwrite, |out| out.write_all(tables_text(tables).as_bytes()))?,
        Aside::written(&nodes, overwrite, |out| out.write_all(kernel_text(kernel).as_bytes()))?,
    ];
    put_all_in_place(written)?;
    Ok(vec![rows, nodes])
}

/// Reads both files for `path`, which is a path as [`paths`] takes it or the name of one of them. Returns their content and
/// what it was read from.
///
/// # Errors
/// [`TableFileError`] when one of them cannot be read or is no memory image of tables.
pub fn read(path: &Path) -> Result<(TableSet, Kernel, [Input; 2]), TableFileError> {
    let [rows, nodes] = paths(&name_of_both(path));
    let (tables, rows) = read_one(rows, parse_tables)?;
    let (kernel, nodes) = read_one(nodes, parse_kernel)?;
    Ok((tables, kernel, [rows, nodes]))
}

fn read_one<T>(path: PathBuf, parse: fn(&str) -> Result<T, MemError>) -> Result<(T, Input), TableFileError> {
    let text = match text::read(&path, text::MAX_BYTES) {
        Ok(text) => text,
        Err(source) => return Err(TableFileError::Io { path, source }),
    };
    match parse(&text) {
        Ok(content) => Ok((content, Input::of_bytes(&path, text.as_bytes()))),
        Err(source) => Err(TableFileError::mem(path, source)),
    }
}

/// The memory image of the row factors or the grid.
#[must_use]
pub fn tables_text(tables: &TableSet) -> String {
    let geometry = tables.geometry();
    let what = match tables.shape() {
        None => "row factors Q = 2^24 / k for $readmemh: 25 bits a word, row 0 first",
        Some(_) => "grid for $readmemh: 25 bits a word, column by column, offsets first",
    };
    let shape = tables.shape().map(|shape| format!(" v={} k={}", shape.v(), shape.k()));
    let header = [
        format!("// halfrow {what}"),
        format!(
            "// datapath={} width={} height={} bits={} centre2={}{}",
            datapath_of(tables),
            geometry.width(),
            geometry.height(),
            geometry.depth().bits(),
            geometry.centre2(),
            shape.unwrap_or_default()
        ),
    ];
    let words = tables.entries().map(|units| format!("{units:0ENTRY_DIGITS$x}"));
    lines(header.into_iter().chain(words))
}

/// The memory image of the kernel's nodes.
#[must_use]
pub fn kernel_text(kernel: &Kernel) -> String {
    let header = [
        "// halfrow kernel for $readmemh: 80 bits a word, nodes x = 0, 1/32, ..., 2".to_owned(),
        "// g6 r5 g4 r1 g0, g6 most significant; each 16 bits, two's complement, 14 of them fractional"
            .to_owned(),
        format!("// datapath={DATAPATH} {WEIGHT_ORDER}"),
    ];
    let word =
        |node: &[i16; 5]| node.iter().rev().map(|weight| format!("{weight:0WEIGHT_DIGITS$x}")).collect();
    let words = kernel.nodes().iter().map(word);
    lines(header.into_iter().chain(words))
}

fn lines(lines: impl Iterator<Item = String>) -> String {
    lines.flat_map(|line| [line, "\n".to_owned()]).collect()
}

/// The table set of the memory image `text`. Its comments must give the geometry, like those of [`tables_text`].
///
/// # Errors
/// [`MemError`] for the first thing that is wrong: the datapath, the geometry, the words from the top.
pub fn parse_tables(text: &str) -> Result<TableSet, MemError> {
    match datapath(text)? {
        Datapath::RowFactors => Ok(TableSet::from_units(geometry(text)?, &units(text)?)?),
        Datapath::Grids => {
            let shape = GridShape::new(noted(text, Place::V)?, noted(text, Place::K)?)?;
            Ok(TableSet::from_grid(geometry(text)?, shape, &units(text)?)?)
        }
    }
}

fn geometry(text: &str) -> Result<Geometry, MemError> {
    let bits = noted(text, Place::Bits)?;
    let depth = BitDepth::from_bits(bits).ok_or(MemError::Bits { found: bits })?;
    let (width, height) = (noted(text, Place::Width)?, noted(text, Place::Height)?);
    Ok(Geometry::new(width, height, depth, noted(text, Place::Centre2)?)?)
}

fn units(text: &str) -> Result<Vec<u32>, MemError> {
    words::<ENTRY_DIGITS>(text).map(|word| word.map(|units| units as u32)).collect()
}

/// The kernel of the memory image `text`.
///
/// # Errors
/// [`MemError`] for the first thing that is wrong: the datapath, the words from x = 0.
pub fn parse_kernel(text: &str) -> Result<Kernel, MemError> {
    match datapath(text)? {
        // A kernel is the same for both.
        Datapath::RowFactors | Datapath::Grids => {}
    }
    if !notes(text).any(|note| note == WEIGHT_ORDER) {
        return Err(MemError::WeightOrder { order: WEIGHT_ORDER });
    }
    let nodes: Result<_, _> = words::<NODE_DIGITS>(text).map(|word| word.map(weights)).collect();
    Ok(Kernel::from_nodes(nodes?)?)
}

/// The weights g0 r1 g4 r5 g6 in a node's word.
fn weights(word: u128) -> [i16; 5] {
    [0, 16, 32, 48, 64].map(|shift| (word >> shift) as i16)
}

/// The words of `text`, one a line, each `DIGITS` hexadecimal digits.
fn words<const DIGITS: usize>(text: &str) -> impl Iterator<Item = Result<u128, MemError>> {
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    lines.filter(|(_, line)| !line.is_empty() && comment(line).is_none()).map(|(line, word)| {
        let is_word = word.len() == DIGITS && word.bytes().all(|byte| byte.is_ascii_hexdigit());
        let value = is_word.then(|| u128::from_str_radix(word, 16).ok()).flatten();
        value.ok_or_else(|| MemError::Word { line, found: quoted(word), digits: DIGITS })
    })
}

fn comment(line: &str) -> Option<&str> {
    line.trim().strip_prefix("//")
}

/// The words of the comments.
fn notes(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(comment).flat_map(str::split_whitespace)
}

/// The datapath named in the comments.
fn datapath(text: &str) -> Result<Datapath, MemError> {
    Ok(WrongDatapath::check(noted(text, Place::Datapath)?)?)
}

/// The number given in the comments as `key=number`.
fn noted<T: FromStr + PartialEq>(text: &str, place: Place) -> Result<T, MemError> {
    let mut values = notes(text)
        .filter_map(|note| note.strip_prefix(place.key())?.strip_prefix('='))
        .map(|value| value.parse().ok());
    let first = values.next().flatten();
    first.filter(|first| values.all(|other| other.as_ref() == Some(first))).ok_or(MemError::Header(place))
}

//! The resources claimed in Sect. 4.2: on average less than a tenth of a Spartan-6 LX25.

use std::io;
use std::path::{Path, PathBuf};

use halfrow::files::text;
use serde::Deserialize;

use super::exhibit::{Accepted, Cell, Claim, Exhibit, Table};
use super::expected::RESOURCES_PERCENT;
use super::{Item, PaperError};

/// The document that `scripts/hardware resources` writes.
#[derive(Debug, Deserialize)]
struct Report {
    /// The synthesis program.
    tool: String,
    device: String,
    builds: Vec<Build>,
}

/// One build of the Verilog.
#[derive(Debug, Deserialize)]
struct Build {
    name: String,
    luts: Share,
    registers: Share,
    block_rams: Share,
    dsps: Share,
    /// The mean of the four shares, in percent.
    mean: f64,
}

/// The number used, and its share of the device.
#[derive(Debug, Deserialize)]
struct Share {
    used: f64,
    percent: f64,
}

/// The build that has just what the paper's algorithm needs: Hermite takes five taps.
const PAPER_BUILD: &str = "core, 5 taps, 1 bank";

/// What `scripts/hardware resources` has reported, if it has.
#[derive(Debug)]
pub struct Synthesis {
    path: PathBuf,
    report: Option<Report>,
}

impl Synthesis {
    /// The report in the file `path`.
    ///
    /// # Errors
    /// [`PaperError::Synthesis`] when it cannot be used.
    pub fn read(path: &Path) -> Result<Self, PaperError> {
        let wrong = |source| PaperError::Synthesis { path: path.to_owned(), source };
        let text = text::read(path, text::MAX_BYTES).map_err(wrong)?;
        // An `Option` would take `null` for a report that is not there.
        let report = serde_json::from_str::<Report>(&text).map_err(|source| wrong(source.into()))?;
        Ok(Self { path: path.to_owned(), report: Some(report) })
    }

    /// The report in the file `path`, which need not be there.
    ///
    /// # Errors
    /// [`PaperError::Synthesis`] when it is there and cannot be used.
    pub fn read_if_there(path: &Path) -> Result<Self, PaperError> {
        match Self::read(path) {
            Err(PaperError::Synthesis { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                Ok(Self::none(path))
            }
            read => read,
        }
    }

    /// No report at `path`, for items that need none.
    #[must_use]
    pub fn none(path: &Path) -> Self {
        Self { path: path.to_owned(), report: None }
    }
}

/// The claim, if there is a report; otherwise how to make one.
pub(super) fn exhibit(synthesis: &Synthesis) -> Exhibit {
    let mut exhibit = Exhibit::new(Item::Resources);
    let path = synthesis.path.display();
    let Some(report) = &synthesis.report else {
        exhibit.open.push(format!(
            "there is no synthesis report at {path}: run `scripts/hardware resources` in the project's folder, or name one \
             with --synthesis"
        ));
        return exhibit;
    };
    exhibit.remark(format!(
        "Synthesised with {} for the {}; it counts no slices. The mean is that of the shares of LUTs, registers, block RAMs \
         and DSP slices. The claim is held to the build of five taps, which is all that Hermite takes; cubic takes seven.",
        report.tool, report.device
    ));
    exhibit.claims.extend(report.builds.iter().filter(|build| build.name == PAPER_BUILD).map(|build| {
        Claim {
            what: format!("mean share of the device, {}", build.name),
            unit: "%",
            paper: None,
            found: build.mean,
            accepted: Accepted::Below(RESOURCES_PERCENT),
            judges_board: false,
        }
    }));
    if exhibit.claims.is_empty() {
        exhibit.open.push(format!("{path} has no build `{PAPER_BUILD}`: make it anew"));
    }
    exhibit.tables.push(table(report));
    exhibit
}

fn table(report: &Report) -> Table {
    let kinds = ["LUTs", "registers", "block RAMs", "DSP48A1"];
    let heads = kinds.into_iter().flat_map(|kind| [kind.to_owned(), format!("{kind}, %")]);
    let row = |build: &Build| {
        let shares = [&build.luts, &build.registers, &build.block_rams, &build.dsps];
        let cells = shares.into_iter().flat_map(|share| {
            let whole = if share.used.fract() == 0.0 { 0 } else { 1 };
            [Cell::Number(share.used, whole), Cell::Number(share.percent, 1)]
        });
        std::iter::once(Cell::Text(build.name.clone()))
            .chain(cells)
            .chain([Cell::Number(build.mean, 1)])
            .collect()
    };
    Table {
        name: "resources",
        caption: "What each build takes of the device.".to_owned(),
        columns: ["build".to_owned()].into_iter().chain(heads).chain(["mean, %".to_owned()]).collect(),
        rows: report.builds.iter().map(row).collect(),
        on_page: true,
    }
}

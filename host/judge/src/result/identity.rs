//! What a board says about itself, as reports carry it.

use halfrow_model::BitDepth;
use serde::{Deserialize, Serialize};

use crate::board::{Bursts, Capabilities, Welcome, grids};
use crate::words::{board_name, count};

/// What a board says about itself.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Its name.
    pub name: String,
    /// Its serial number, in hexadecimal; zeros if it has none.
    pub serial: String,
    /// The start of the commit that it was built from, in hexadecimal.
    pub build: String,
    /// The wire's version.
    pub protocol: u8,
    /// The datapath id.
    pub datapath: u16,
    /// The widest row.
    pub max_width: u16,
    /// The most rows in a frame.
    pub max_height: u16,
    /// Sample depths, in bits.
    pub depths: Vec<u8>,
    /// Taps: 5 or 7.
    pub taps: u8,
    /// L, in pixel clocks.
    pub latency: u8,
    /// M, in samples.
    pub ring: u16,
    /// Fewest pixel clocks between rows.
    pub least_blanking: u16,
    /// Banks of tables.
    pub table_banks: u8,
    /// Banks for rows on their way into the core.
    pub row_banks_in: u8,
    /// Banks for rows that come out of the core.
    pub row_banks_out: u8,
    /// The pixel clock in hertz; 0 when it stands for no real time.
    pub clock_hz: u32,
    /// The frames that it makes itself; none if it makes none.
    #[serde(default)]
    pub bursts: Option<BurstsReport>,
    /// Whether each row comes back with the CRC-32 of what entered the core.
    #[serde(default)]
    pub entered: bool,
    /// The grids of datapath 2 that it takes; none if it takes only one factor a row.
    #[serde(default)]
    pub grids: Option<GridsReport>,
}

/// The grids that a board takes (DATAPATH.md, datapath 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GridsReport {
    /// T: the entries that a bank holds.
    pub entries: u16,
    /// Fewest pixel clocks between rows of a grid that are narrower than `width`.
    #[serde(rename = "least_blanking")]
    pub grid_blanking: u8,
    /// The width in columns from which rows of a grid need no more blanking than others.
    pub width: u16,
}

/// The frames that a board makes itself at the full pixel clock (AT-SPEED.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BurstsReport {
    /// The content id.
    pub content: u16,
    /// Records that it keeps until a host has them.
    pub records: u16,
    /// Fewest pixel clocks between two frames.
    pub least_frame_blanking: u16,
    /// Whether it has a trap, which keeps a row whose signature is not the expected one.
    pub trap: bool,
}

impl BurstsReport {
    fn of(bursts: Bursts) -> Self {
        let Bursts { content, records, least_frame_blanking, trap } = bursts;
        Self { content, records, least_frame_blanking, trap }
    }

    /// A line for people.
    fn text(&self) -> String {
        let trap = if self.trap { "keeps the first wrong row" } else { "keeps no row" };
        format!("yes (content {}): {}, {trap}", self.content, count(self.records, "record"))
    }
}

impl GridsReport {
    /// A line for people.
    fn text(&self) -> String {
        format!(
            "at most {} entries; {} pixel clocks between rows of less than {} columns",
            self.entries, self.grid_blanking, self.width
        )
    }
}

impl Identity {
    /// The identity in the board's answers.
    #[must_use]
    pub fn of(welcome: &Welcome, capabilities: &Capabilities) -> Self {
        let depths = capabilities.sample_depths();
        Self {
            name: capabilities.name.clone(),
            serial: format!("{:016x}", welcome.serial),
            build: format!("{:08x}", welcome.build),
            protocol: welcome.version,
            datapath: capabilities.datapath,
            max_width: capabilities.max_width,
            max_height: capabilities.max_height,
            depths: BitDepth::ALL
                .map(|depth| depth.bits() as u8)
                .into_iter()
                .filter(|&bits| depths.has(bits))
                .collect(),
            taps: capabilities.taps,
            latency: capabilities.latency,
            ring: capabilities.ring,
            least_blanking: capabilities.least_blanking,
            table_banks: capabilities.table_banks,
            row_banks_in: capabilities.row_banks_in,
            row_banks_out: capabilities.row_banks_out,
            clock_hz: capabilities.clock_hz,
            bursts: capabilities.bursts.map(BurstsReport::of),
            entered: capabilities.entered,
            grids: grids(capabilities).map(|of| GridsReport {
                entries: of.entries,
                grid_blanking: of.grid_blanking,
                width: of.grid_width,
            }),
        }
    }

    /// The datapaths that it has: `1` or `1 and 2`.
    #[must_use]
    pub fn datapaths(&self) -> String {
        let further = if self.grids.is_some() { " and 2" } else { "" };
        format!("{}{further}", self.datapath)
    }

    /// Names and values for people, line by line.
    #[must_use]
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let depths: Vec<String> = self.depths.iter().map(u8::to_string).collect();
        let clock = match self.clock_hz {
            0 => "stands for no real time".to_owned(),
            hertz => format!("{:.3} MHz", f64::from(hertz) / 1e6),
        };
        vec![
            ("name", board_name(&self.name).into_owned()),
            ("serial", self.serial.clone()),
            ("build", self.build.clone()),
            ("wire version", self.protocol.to_string()),
            ("datapath", self.datapaths()),
            ("grids", self.grids.map_or_else(|| "none".to_owned(), |grids| grids.text())),
            ("frame at most", format!("{} x {}", self.max_width, self.max_height)),
            ("depths", format!("{} bits", depths.join(", "))),
            ("taps", self.taps.to_string()),
            ("pipeline delay (L)", count(self.latency, "pixel clock")),
            ("line memory (M)", format!("{} samples", self.ring)),
            ("least blanking", count(self.least_blanking, "pixel clock")),
            ("table banks", self.table_banks.to_string()),
            ("row banks", format!("{} in, {} out", self.row_banks_in, self.row_banks_out)),
            ("pixel clock", clock),
            ("frames at speed", self.bursts.map_or_else(|| "none".to_owned(), |bursts| bursts.text())),
            ("input rows", if self.entered { "CRC reported" } else { "CRC not reported" }.to_owned()),
        ]
    }
}

//! What a board says of itself, as reports carry it.

use serde::{Deserialize, Serialize};

use crate::board::{Capabilities, Welcome};

/// What a board says of itself.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Its name.
    pub name: String,
    /// Its serial number, in hexadecimal.
    pub serial: String,
    /// The commit of its build, in hexadecimal.
    pub build: String,
    /// The wire's version.
    pub protocol: u8,
    /// The datapath id.
    pub datapath: u16,
    /// The widest row.
    pub max_width: u16,
    /// The most rows.
    pub max_height: u16,
    /// Sample depths, in bits.
    pub depths: Vec<u8>,
    /// 5 or 7.
    pub taps: u8,
    /// L.
    pub latency: u8,
    /// M.
    pub ring: u16,
    /// Fewest pixel clocks between rows.
    pub least_blanking: u16,
    /// Banks of tables.
    pub table_banks: u8,
    /// Row banks towards the core.
    pub row_banks_in: u8,
    /// Row banks from the core.
    pub row_banks_out: u8,
    /// The pixel clock in hertz, 0 when it stands for no real time.
    pub clock_hz: u32,
}

impl Identity {
    /// From the board's answers.
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
            depths: [8, 10, 12].into_iter().filter(|&bits| depths.has(bits)).collect(),
            taps: capabilities.taps,
            latency: capabilities.latency,
            ring: capabilities.ring,
            least_blanking: capabilities.least_blanking,
            table_banks: capabilities.table_banks,
            row_banks_in: capabilities.row_banks_in,
            row_banks_out: capabilities.row_banks_out,
            clock_hz: capabilities.clock_hz,
        }
    }

    /// For people: name and value, line by line.
    #[must_use]
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let depths: Vec<String> = self.depths.iter().map(u8::to_string).collect();
        let clock = match self.clock_hz {
            0 => "stands for no real time".to_owned(),
            hertz => format!("{:.3} MHz", f64::from(hertz) / 1e6),
        };
        vec![
            ("name", self.name.clone()),
            ("serial", self.serial.clone()),
            ("build", self.build.clone()),
            ("wire version", self.protocol.to_string()),
            ("datapath", self.datapath.to_string()),
            ("frame at most", format!("{} x {}", self.max_width, self.max_height)),
            ("depths", format!("{} bits", depths.join(", "))),
            ("taps", self.taps.to_string()),
            ("L", format!("{} pixel clocks", self.latency)),
            ("M", format!("{} samples", self.ring)),
            ("least blanking", format!("{} pixel clocks", self.least_blanking)),
            ("table banks", self.table_banks.to_string()),
            ("row banks", format!("{} in, {} out", self.row_banks_in, self.row_banks_out)),
            ("pixel clock", clock),
        ]
    }
}

//! CAPABILITIES: what a board is, as a list of tagged values.

use alloc::string::String;
use alloc::vec::Vec;

use super::{Datapath, UnknownDatapath};
use crate::Malformed;
use crate::bytes::Fields;

/// What is at the other end of the wire, as the board itself reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum BoardNature {
    /// An FPGA.
    Hardware = 1,
    /// The Verilog under simulation.
    Simulation = 2,
    /// The mock board.
    Mock = 3,
}

/// Where a board's pixel clock comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ClockSource {
    /// The host: the board is a mock or a simulation.
    Host = 0,
    /// The sensor's PIXCLK.
    Pixclk = 1,
    /// A PLL.
    Pll = 2,
}

/// The sample depths that a board supports: bit 0 for 8, bit 1 for 10, bit 2 for 12 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Depths(pub u8);

impl Depths {
    /// 8, 10 and 12 bits.
    pub const ALL: Self = Self(0b111);

    /// Whether samples of `bits` bits can be configured.
    #[must_use]
    pub fn has(self, bits: u8) -> bool {
        match bits {
            8 => self.0 & 1 != 0,
            10 => self.0 & 2 != 0,
            12 => self.0 & 4 != 0,
            _ => false,
        }
    }
}

/// A board's support for AT-SPEED.md: frames that it makes and signs on its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bursts {
    /// The content id: which samples a seed generates. A host asks for no burst if it does not know the id.
    pub content: u16,
    /// How many records the board keeps until a host has them, at least 2.
    pub records: u16,
    /// The fewest pixel clocks between two frames.
    pub least_frame_blanking: u16,
    /// Whether a row whose signature is not the expected one is kept.
    pub trap: bool,
}

impl Bursts {
    fn write(&self) -> [u8; 7] {
        let [[c0, c1], [r0, r1], [b0, b1]] =
            [self.content, self.records, self.least_frame_blanking].map(u16::to_le_bytes);
        [c0, c1, r0, r1, b0, b1, self.trap.into()]
    }

    /// A value without bytes is as none.
    fn read(mut value: Fields<'_>) -> Result<Option<Self>, Malformed> {
        if value.0.is_empty() {
            return Ok(None);
        }
        let bursts = Self {
            content: value.u16()?,
            records: value.u16()?,
            least_frame_blanking: value.u16()?,
            trap: value.u8()? != 0,
        };
        Ok(value.end(Some(bursts)))
    }
}

/// A board's support for a datapath in addition to [`Capabilities::datapath`] (DATAPATH.md, *Datapath 2*).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grids {
    /// The id of the further datapath. A host uses none other than 2.
    pub further_datapath: u16,
    /// T: entries in a bank, at least 2048 and at least `max_height`.
    pub entries: u16,
    /// Bit k is set for every k that the board takes; at least bit 5 or bit 6.
    pub ks: u8,
    /// The fewest pixel clocks between rows corrected by a grid that are narrower than `grid_width`.
    pub grid_blanking: u8,
    /// The row width from which on rows corrected by a grid need no more blanking than others, in samples.
    pub grid_width: u16,
}

impl Grids {
    /// Whether the board takes grids with a node every 2^k columns.
    #[must_use]
    pub fn takes(&self, k: u8) -> bool {
        self.ks.checked_shr(k.into()).is_some_and(|ks| ks & 1 == 1)
    }

    fn write(&self) -> [u8; 8] {
        let [[d0, d1], [e0, e1], [w0, w1]] =
            [self.further_datapath, self.entries, self.grid_width].map(u16::to_le_bytes);
        [d0, d1, e0, e1, self.ks, self.grid_blanking, w0, w1]
    }

    /// A value without bytes is as none.
    fn read(mut value: Fields<'_>) -> Result<Option<Self>, Malformed> {
        if value.0.is_empty() {
            return Ok(None);
        }
        let grids = Self {
            further_datapath: value.u16()?,
            entries: value.u16()?,
            ks: value.u8()?,
            grid_blanking: value.u8()?,
            grid_width: value.u16()?,
        };
        Ok(value.end(Some(grids)))
    }
}

macro_rules! capabilities {
    ($($(#[$doc:meta])* $tag:literal $name:ident: $type:ident,)*) => {
        /// What a board is and can do.
        #[derive(Clone, Debug, PartialEq, Eq)]
        pub struct Capabilities {
            $($(#[$doc])* pub $name: $type,)*
            /// Its support for bursts; none if it makes no bursts.
            pub bursts: Option<Bursts>,
            /// Whether ROW_OUT ends with the CRC-32 of the samples that entered the core.
            pub entered: bool,
            /// Its support for grids; none if it has datapath 1 only.
            pub grids: Option<Grids>,
            /// What is at the other end of the wire.
            pub nature: BoardNature,
            /// The board's name, for people; UTF-8, at most 255 bytes.
            pub name: String,
        }

        impl Capabilities {
            const BURSTS: u8 = 0x10;
            const ENTERED: u8 = 0x11;
            const GRIDS: u8 = 0x12;
            const NATURE: u8 = 0x20;
            const NAME: u8 = 0x21;

            pub(crate) fn write(&self, payload: &mut Vec<u8>) {
                $(tagged(payload, $tag, &self.$name.to_le_bytes());)*
                if let Some(bursts) = &self.bursts {
                    tagged(payload, Self::BURSTS, &bursts.write());
                }
                if self.entered {
                    tagged(payload, Self::ENTERED, &[1]);
                }
                if let Some(grids) = &self.grids {
                    tagged(payload, Self::GRIDS, &grids.write());
                }
                tagged(payload, Self::NATURE, &[self.nature as u8]);
                tagged(payload, Self::NAME, cut(&self.name).as_bytes());
            }

            pub(crate) fn read(mut fields: Fields<'_>) -> Result<Self, Malformed> {
                $(let mut $name = None;)*
                let (mut bursts, mut entered, mut grids) = (None, false, None);
                let (mut nature, mut name) = (None, String::new());
                while !fields.0.is_empty() {
                    let tag = fields.u8()?;
                    let length = fields.u8()?;
                    let mut value = Fields(fields.take(usize::from(length))?);
                    match tag {
                        $($tag => $name = Some($type::from_le_bytes(value.array()?)),)*
                        Self::BURSTS => bursts = Bursts::read(value)?,
                        Self::ENTERED => entered = length > 0 && value.u8()? != 0,
                        Self::GRIDS => grids = Grids::read(value)?,
                        Self::NATURE => nature = Some(BoardNature::from_code(value.u8()?)?),
                        Self::NAME => name = cut(&String::from_utf8_lossy(value.rest())).into(),
                        _ => {}
                    }
                }
                Ok(Self {
                    $($name: $name.ok_or(Malformed::MissingCapability(stringify!($name)))?,)*
                    bursts,
                    entered,
                    grids,
                    nature: nature.ok_or(Malformed::MissingCapability("nature"))?,
                    name,
                })
            }
        }
    };
}

capabilities! {
    /// The datapath's id: which arithmetic the board computes. [`Self::known_datapath`] returns it if it is known.
    0x01 datapath: u16,
    /// The widest row, in samples.
    0x02 max_width: u16,
    /// The most rows of a frame.
    0x03 max_height: u16,
    /// Sample depths: bit 0 for 8, bit 1 for 10, bit 2 for 12 bits.
    0x04 depths: u8,
    /// 5, or 7 if the board has the outer taps.
    0x05 taps: u8,
    /// L: a sample leaves W/2 + L pixel clocks after it enters.
    0x06 latency: u8,
    /// M: samples that the line memory holds, a power of two.
    0x07 ring: u16,
    /// The fewest pixel clocks between two rows.
    0x08 least_blanking: u16,
    /// Banks of tables: 2 if one can be written while the other is in use.
    0x09 table_banks: u8,
    /// How many rows the board holds before they are played.
    0x0a row_banks_in: u8,
    /// How many corrected rows it holds until they are acknowledged.
    0x0b row_banks_out: u8,
    /// Ports through which the datapath reads row factors.
    0x0c step_ports: u8,
    /// Ports through which it reads the kernel.
    0x0d kernel_ports: u8,
    /// The code of a [`ClockSource`]. [`Self::source_of_clock`] returns it if it is known.
    0x0e clock_source: u8,
    /// The frequency of the pixel clock in hertz; 0 if it is not known.
    0x0f clock_hz: u32,
}

impl Capabilities {
    /// The datapath that [`Self::datapath`] names.
    ///
    /// # Errors
    /// [`UnknownDatapath`]: a host can neither make tables for such a board nor judge it.
    pub fn known_datapath(&self) -> Result<Datapath, UnknownDatapath> {
        match self.datapath.try_into()? {
            Datapath::RowFactors => Ok(Datapath::RowFactors),
            // A separate capability reports this one; every board names datapath 1 here.
            Datapath::Grids => Err(UnknownDatapath { id: self.datapath }),
        }
    }

    /// The source of the pixel clock; none if [`Self::clock_source`] is no code of one.
    #[must_use]
    pub fn source_of_clock(&self) -> Option<ClockSource> {
        [ClockSource::Host, ClockSource::Pixclk, ClockSource::Pll]
            .into_iter()
            .find(|&source| source as u8 == self.clock_source)
    }

    /// The sample depths.
    #[must_use]
    pub fn sample_depths(&self) -> Depths {
        Depths(self.depths)
    }
}

impl BoardNature {
    fn from_code(code: u8) -> Result<Self, Malformed> {
        match code {
            1 => Ok(Self::Hardware),
            2 => Ok(Self::Simulation),
            3 => Ok(Self::Mock),
            _ => Err(Malformed::Value { field: "nature", value: code.into() }),
        }
    }
}

/// As much of `text` as fits into a value, in whole characters.
fn cut(text: &str) -> &str {
    &text[..text.floor_char_boundary(usize::from(u8::MAX))]
}

/// Appends a value of at most 255 bytes.
fn tagged(payload: &mut Vec<u8>, tag: u8, value: &[u8]) {
    #[expect(clippy::cast_possible_truncation, reason = "integers are short, and names are cut")]
    payload.extend_from_slice(&[tag, value.len() as u8]);
    payload.extend_from_slice(value);
}

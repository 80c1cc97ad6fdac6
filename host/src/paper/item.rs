//! The items of the paper.

use clap::ValueEnum;

/// A figure, a table or a claim of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
#[value(rename_all = "lower")]
pub enum Item {
    /// Maps of longitude and latitude: the fisheye model and the exact projection
    Fig3,
    /// A fisheye picture in perspective, Mercator and the exact projection
    Fig4,
    /// The error of the simplified projection, and its two means
    Fig5,
    /// The simplified projection, as a map and as a picture
    Fig6,
    /// The interpolants
    Fig8,
    /// Details of a corrected photograph, enlarged
    Fig12,
    /// PSNR of 24 photographs, in double precision, in integers and through a board
    Table1,
    /// The delay of half a row, measured on a board
    Delay,
    /// The resources of the FPGA, from the synthesis report
    Resources,
}

impl Item {
    /// All of them, in the paper's order.
    pub const ALL: [Self; 9] = [
        Self::Fig3,
        Self::Fig4,
        Self::Fig5,
        Self::Fig6,
        Self::Fig8,
        Self::Fig12,
        Self::Table1,
        Self::Delay,
        Self::Resources,
    ];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fig3 => "fig3",
            Self::Fig4 => "fig4",
            Self::Fig5 => "fig5",
            Self::Fig6 => "fig6",
            Self::Fig8 => "fig8",
            Self::Fig12 => "fig12",
            Self::Table1 => "table1",
            Self::Delay => "delay",
            Self::Resources => "resources",
        }
    }

    /// What it is called on the page.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Fig3 => "Fig. 3: longitudes and latitudes",
            Self::Fig4 => "Fig. 4: one fisheye picture in several projections",
            Self::Fig5 => "Fig. 5: the error of the simplified projection",
            Self::Fig6 => "Fig. 6: the simplified projection",
            Self::Fig8 => "Fig. 8: the interpolants",
            Self::Fig12 => "Fig. 12: details of a corrected photograph",
            Self::Table1 => "Table 1: PSNR of the interpolations over 24 photographs",
            Self::Delay => "Sect. 4.2: the delay of half a row",
            Self::Resources => "Sect. 4.2: the resources of the FPGA",
        }
    }

    /// Whether it goes through a board, or does when one is named.
    #[must_use]
    pub fn goes_through_boards(self) -> bool {
        matches!(self, Self::Table1 | Self::Delay)
    }

    /// Whether it takes the photographs of `--images`.
    #[must_use]
    pub fn needs_photographs(self) -> bool {
        matches!(self, Self::Fig12 | Self::Table1)
    }
}

//! The items of the paper.

use std::str::FromStr;

/// A figure, a table or a claim of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Item {
    /// Maps of longitude and latitude: the fisheye model and the exact projection.
    Fig3,
    /// A fisheye picture in perspective, Mercator and the exact projection.
    Fig4,
    /// The error of the simplified projection, and its two means.
    Fig5,
    /// The simplified projection, as a map and as a picture.
    Fig6,
    /// The interpolants.
    Fig8,
    /// Details of a corrected photograph, enlarged.
    Fig12,
    /// Eq. 9, fitted rows and the exact projection side by side, on the map of Fig. 5 and on façades.
    Verticals,
    /// What each of them leaves of the exact projection, per lens, frame and optical centre.
    Residuals,
    /// PSNR of 24 photographs, in double precision, in integers and through a board.
    Table1,
    /// The delay of half a row, measured on a board.
    Delay,
    /// The resources of the FPGA, from the synthesis report.
    Resources,
}

/// A name that is no item's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no item of the paper; it has fig3, fig4, fig5, fig6, fig8, fig12, verticals, residuals, table1, delay and resources"
)]
pub struct UnknownItem(pub String);

/// What is said of an item.
struct Words {
    name: &'static str,
    title: &'static str,
    summary: &'static str,
}

/// In the order of [`Item`].
const WORDS: [Words; 11] = [
    Words {
        name: "fig3",
        title: "Fig. 3: longitudes and latitudes",
        summary: "Maps of longitude and latitude: the fisheye model and the exact projection",
    },
    Words {
        name: "fig4",
        title: "Fig. 4: one fisheye picture in several projections",
        summary: "A fisheye picture in perspective, Mercator and the exact projection",
    },
    Words {
        name: "fig5",
        title: "Fig. 5: the error of the simplified projection",
        summary: "The error of the simplified projection, and its two means",
    },
    Words {
        name: "fig6",
        title: "Fig. 6: the simplified projection",
        summary: "The simplified projection, as a map and as a picture",
    },
    Words { name: "fig8", title: "Fig. 8: the interpolants", summary: "The interpolants" },
    Words {
        name: "fig12",
        title: "Fig. 12: details of a corrected photograph",
        summary: "Details of a corrected photograph, enlarged",
    },
    Words {
        name: "verticals",
        title: "Beyond Fig. 5: Eq. 9, fitted rows and the exact projection side by side",
        summary: "Eq. 9, fitted rows and the exact projection side by side, on the map of Fig. 5 and on façades",
    },
    Words {
        name: "residuals",
        title: "Beyond Fig. 5: what is left, per lens, frame and optical centre",
        summary: "What each of them leaves of the exact projection, per lens, frame and optical centre",
    },
    Words {
        name: "table1",
        title: "Table 1: PSNR of the interpolations over 24 photographs",
        summary: "PSNR of 24 photographs, in double precision, in integers and through a board",
    },
    Words {
        name: "delay",
        title: "Sect. 4.2: the delay of half a row",
        summary: "The delay of half a row, measured on a board",
    },
    Words {
        name: "resources",
        title: "Sect. 4.2: the resources of the FPGA",
        summary: "The resources of the FPGA, from the synthesis report",
    },
];

impl Item {
    /// All of them, in the paper's order.
    pub const ALL: [Self; 11] = [
        Self::Fig3,
        Self::Fig4,
        Self::Fig5,
        Self::Fig6,
        Self::Fig8,
        Self::Fig12,
        Self::Verticals,
        Self::Residuals,
        Self::Table1,
        Self::Delay,
        Self::Resources,
    ];

    fn words(self) -> &'static Words {
        &WORDS[self as usize]
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.words().name
    }

    /// What it is called on the page.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.words().title
    }

    /// What it shows, in one line.
    #[must_use]
    pub fn summary(self) -> &'static str {
        self.words().summary
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

impl FromStr for Item {
    type Err = UnknownItem;

    fn from_str(name: &str) -> Result<Self, UnknownItem> {
        let found = Self::ALL.into_iter().find(|item| item.name() == name);
        found.ok_or_else(|| UnknownItem(name.to_owned()))
    }
}

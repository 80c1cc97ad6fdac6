//! The items of the paper.

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

/// The words for an item.
struct Words {
    name: &'static str,
    title: &'static str,
    summary: &'static str,
    files: &'static [&'static str],
}

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

    /// The one with this name, if any.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|item| item.name() == name)
    }

    #[expect(clippy::too_many_lines, reason = "one arm an item")]
    fn words(self) -> Words {
        match self {
            Self::Fig3 => Words {
                name: "fig3",
                title: "Fig. 3: longitudes and latitudes",
                summary: "Maps of longitude and latitude: the fisheye model and the exact projection",
                files: &["fig-3.csv", "fig-3a.svg", "fig-3b.svg"],
            },
            Self::Fig4 => Words {
                name: "fig4",
                title: "Fig. 4: one fisheye picture in several projections",
                summary: "A fisheye picture in perspective, Mercator and the exact projection",
                files: &[
                    "fig-4.csv",
                    "fig-4-lines.csv",
                    "fig-4a.png",
                    "fig-4b.png",
                    "fig-4c.png",
                    "fig-4d.png",
                    "fig-4e.png",
                ],
            },
            Self::Fig5 => Words {
                name: "fig5",
                title: "Fig. 5: the error of the simplified projection",
                summary: "The error of the simplified projection, and its two means",
                files: &["fig-5.csv", "fig-5b.png"],
            },
            Self::Fig6 => Words {
                name: "fig6",
                title: "Fig. 6: the simplified projection",
                summary: "The simplified projection, as a map and as a picture",
                files: &["fig-6a.csv", "fig-6a.svg", "fig-6b.csv", "fig-6b.png"],
            },
            Self::Fig8 => Words {
                name: "fig8",
                title: "Fig. 8: the interpolants",
                summary: "The interpolants",
                files: &["fig-8.csv", "fig-8a.svg", "fig-8b.svg", "fig-8c.svg"],
            },
            Self::Fig12 => Words {
                name: "fig12",
                title: "Fig. 12: details of a corrected photograph",
                summary: "Details of a corrected photograph, enlarged",
                files: &[
                    "fig-12.csv",
                    "fig-12-linear.png",
                    "fig-12-linear-yellow.png",
                    "fig-12-linear-blue.png",
                    "fig-12-cubic.png",
                    "fig-12-cubic-yellow.png",
                    "fig-12-cubic-blue.png",
                    "fig-12-hermite.png",
                    "fig-12-hermite-yellow.png",
                    "fig-12-hermite-blue.png",
                    "fig-12-original.png",
                    "fig-12-original-yellow.png",
                    "fig-12-original-blue.png",
                ],
            },
            Self::Verticals => Words {
                name: "verticals",
                title: "Beyond Fig. 5: Eq. 9, fitted rows and the exact projection side by side",
                summary: "Eq. 9, fitted rows and the exact projection side by side, on the map of Fig. 5 and on façades",
                files: &[
                    "map.csv",
                    "verticals.csv",
                    "verticals-edges.csv",
                    "map-equation-9.png",
                    "map-fitted.png",
                    "map-exact.png",
                    "facades-paper-equation-9.png",
                    "facades-paper-fitted.png",
                    "facades-paper-exact.png",
                    "facades-dsl215-equation-9.png",
                    "facades-dsl215-fitted.png",
                    "facades-dsl215-exact.png",
                ],
            },
            Self::Residuals => Words {
                name: "residuals",
                title: "Beyond Fig. 5: what is left, per lens, frame and optical centre",
                summary: "What each of them leaves of the exact projection, per lens, frame and optical centre",
                files: &["residuals.csv", "residuals-exact.csv"],
            },
            Self::Table1 => Words {
                name: "table1",
                title: "Table 1: PSNR of the interpolations over 24 photographs",
                summary: "PSNR of 24 photographs, in double precision, in integers and through a board",
                files: &["table-1.csv", "table-1-integers.csv", "table-1-board.csv"],
            },
            Self::Delay => Words {
                name: "delay",
                title: "Sect. 4.2: the delay of half a row",
                summary: "The delay of half a row, measured on a board",
                files: &["delay.csv"],
            },
            Self::Resources => Words {
                name: "resources",
                title: "Sect. 4.2: the resources of the FPGA",
                summary: "The resources of the FPGA, from the synthesis report",
                files: &["resources.csv"],
            },
        }
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.words().name
    }

    /// Its title on the page.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.words().title
    }

    /// What it shows, in one line.
    #[must_use]
    pub fn summary(self) -> &'static str {
        self.words().summary
    }

    /// The files that it may write, one for each of its tables and pictures.
    #[must_use]
    pub fn files(self) -> &'static [&'static str] {
        self.words().files
    }

    /// Whether it is tried on a board: always, or `through_board`, which says whether Table 1 goes through the board too.
    #[must_use]
    pub fn uses_board(self, through_board: bool) -> bool {
        self == Self::Delay || self == Self::Table1 && through_board
    }

    /// Whether it takes the photographs of `--images`.
    #[must_use]
    pub fn needs_photographs(self) -> bool {
        matches!(self, Self::Fig12 | Self::Table1)
    }
}

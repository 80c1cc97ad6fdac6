//! Plans that a plant publishes: signed by an engineer, fetched, verified and kept by every station.
//!
//! ```text
//!  engineer: plan and files ─► bundle ─┐
//!            key ─► statement, signed ─┴► plant ─► station: is it signed by somebody we trust, and newer than ours?
//!                                                    └► kept, by its hash; it goes on with it without the plant
//! ```
//!
//! A plant's database may be anybody's: what a station judges by is what an engineer has signed, and never less than it had.

mod bundle;
mod fetched;
mod kept;
mod signed;

pub use bundle::{Bundle, BundleError};
pub use fetched::{FetchError, Fetched, fetch};
pub use kept::Kept;
pub use signed::{PublicKey, SigningError, SigningKey, Statement};

/// What a plan's place begins with in settings when the plant publishes it.
pub(crate) const PLACE: &str = "plant:";

/// A plan by its product and name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PlanName {
    /// The product.
    pub product: String,
    /// The plan's name.
    pub name: String,
}

impl PlanName {
    /// The plan that a place in settings names, if the plant publishes it: `plant:PRODUCT/NAME`.
    #[must_use]
    pub fn of_place(place: &str) -> Option<Self> {
        let (product, name) = place.strip_prefix(PLACE)?.split_once('/')?;
        let is_whole = !product.is_empty() && !name.is_empty();
        is_whole.then(|| Self { product: product.to_owned(), name: name.to_owned() })
    }
}

impl std::fmt::Display for PlanName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.product, self.name)
    }
}

//! Plans that a plant publishes: signed by an engineer, fetched, verified and kept by every station.
//!
//! ```text
//!  engineer: plan and files ─► bundle ─┐
//!            key ─► statement, signed ─┴► plant ─► station: is it signed by somebody we trust, and newer than ours?
//!                                                    └► kept, by its hash; it goes on with it without the plant
//! ```
//!
//! A plant's database may be anybody's, so a station judges only by what an engineer has signed, and never by less
//! than it had.

mod bundle;
mod fetched;
mod kept;
mod signed;

use crate::plan::PlanName;
pub use bundle::{Bundle, BundleError};
pub(crate) use fetched::look_whole;
pub use fetched::{FetchError, Fetched, Offer, offered};
pub use kept::KeptPlans;
pub use signed::{PublicKey, Signed, SigningError, SigningKey, Statement};

/// What a plan's place in settings begins with when the plant publishes the plan.
pub(crate) const PLACE: &str = "plant:";

/// The plan that a place in settings names, if the plant publishes it: `plant:PRODUCT/NAME`.
pub(crate) fn named_by(place: &str) -> Option<PlanName> {
    let (product, plan) = place.strip_prefix(PLACE)?.split_once('/')?;
    let is_whole = !product.is_empty() && !plan.is_empty();
    is_whole.then(|| PlanName { product: product.to_owned(), plan: plan.to_owned() })
}

//! How plans come from the plant to a station: by `plan fetch`, and when it begins its work.

use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use super::beginning::{NoPlant, SettingsFile};
use super::{Failure, tell_lines};
use crate::console;
use crate::exit::Exit;
use crate::guard::guarded;
use crate::plan::PlanName;
use crate::published::{FetchError, Fetched, KeptPlans, Offer, Statement, offered};
use crate::said::Said;
use crate::settings::{PlansOfPlant, Settings};
use crate::store::{Plant, PlantAddress};

/// How long the plant may take to say which plans hold, when a station that has them all begins its work.
const IN_TIME: Duration = Duration::from_secs(20);

/// What is said of a plan that was not here before.
const NEW: &str = ", is new; a station at work goes on with the plan that it has until it is started again";

/// Fetches every plan that the settings take from the plant, and prints which ones are new.
pub(super) fn fetch_all(settings: &SettingsFile) -> Result<Exit, Failure> {
    let published = published(settings)?;
    let mut said = Vec::new();
    for fetched in fetched(&KeptPlans::of(&published.data), offers(&published))? {
        let Fetched { statement: Statement { version, number, .. }, is_new } = fetched?;
        said.push(format!("{version}, number {number}{}", if is_new { NEW } else { "" }));
    }
    let named = published.plans.iter().zip(said).map(|(plan, said)| format!("{plan} {said}"));
    Ok(tell_lines(named))
}

/// Fetches them when a station begins its work. If that fails, the station goes on with the copies that it has, unless
/// one is missing.
pub(super) fn fetch_at_start(settings: &SettingsFile) -> Result<(), Failure> {
    let Ok(published) = Settings::plans_of_plant(&settings.path()?) else { return Ok(()) };
    if published.plans.is_empty() {
        return Ok(());
    }
    let kept = KeptPlans::of(&published.data);
    let is_missing = |plan: &&PlanName| kept.statement(plan, published.trusts()).is_none();
    let missing: Vec<_> = published.plans.iter().filter(is_missing).map(PlanName::to_string).collect();
    if !missing.is_empty() {
        let (missing, folder) = (missing.join(", "), kept.folder().display());
        return all_fetched(&kept, offers(&published)).inspect_err(|_| {
            console::error(&format_args!("no copy of {missing} is in {folder}, so the plant is needed"));
        });
    }
    let Some(offers) = offers_in_time(published) else {
        let seconds = IN_TIME.as_secs();
        console::error(&format_args!(
            "the plans stay as they are: the plant did not answer within {seconds} s"
        ));
        return Ok(());
    };
    if let Err(failure) = all_fetched(&kept, offers) {
        console::error(&format_args!("the plans stay as they are: {}", Said::of(&*failure.error)));
    }
    Ok(())
}

/// What the plant offers for each plan.
type Offers = Result<Vec<Result<Offer, FetchError>>, Failure>;

fn offers(published: &PlansOfPlant) -> Offers {
    let mut at = Plant::connect(&address(published)?)?;
    let (kept, trusted) = (KeptPlans::of(&published.data), published.trusts());
    Ok(published.plans.iter().map(|plan| offered(&mut at, &kept, plan, trusted)).collect())
}

/// The same within [`IN_TIME`], because a plant may accept a connection and never say anything. The thread that asks
/// is then abandoned, and keeps nothing.
fn offers_in_time(published: PlansOfPlant) -> Option<Offers> {
    let (answer, answered) = mpsc::channel();
    let ask = move || {
        let offers = guarded(|| offers(&published)).map_err(Failure::error).flatten();
        // Perhaps nobody waits for it any more.
        let _ = answer.send(offers);
    };
    match thread::Builder::new().name("plans".to_owned()).spawn(ask) {
        Ok(_) => match answered.recv_timeout(IN_TIME) {
            Err(RecvTimeoutError::Timeout) => None,
            answer => Some(answer.map_err(Failure::error).flatten()),
        },
        Err(error) => Some(Err(Failure::error(error))),
    }
}

/// Keeps every plan that can be kept, and returns the outcome for each.
fn fetched(kept: &KeptPlans, offers: Offers) -> Result<Vec<Result<Fetched, FetchError>>, Failure> {
    Ok(offers?.into_iter().map(|offer| offer?.keep(kept)).collect())
}

/// The same, but returns only the first error, if there is one.
fn all_fetched(kept: &KeptPlans, offers: Offers) -> Result<(), Failure> {
    fetched(kept, offers)?.into_iter().try_for_each(|fetched| Ok(fetched.map(drop)?))
}

/// What the settings take from the plant.
pub(super) fn published(settings: &SettingsFile) -> Result<PlansOfPlant, Failure> {
    Ok(Settings::plans_of_plant(&settings.path()?)?)
}

/// Where the plant is.
pub(super) fn address(PlansOfPlant { plant, .. }: &PlansOfPlant) -> Result<PlantAddress, Failure> {
    Ok(plant.as_ref().ok_or_else(|| Failure::call(NoPlant))?.address()?)
}

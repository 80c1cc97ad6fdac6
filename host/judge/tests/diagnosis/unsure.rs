//! Parts that explain little, or spoil much.

use halfrow::result::{Account, Defect, Suspect};

use crate::altered::diagnose;
use crate::bench::narrow;

/// Bit 6 stuck at 1 in the even columns of samples above 2600, which are fewer than those below.
#[test]
fn a_part_that_spoils_more_than_it_explains_is_not_named() {
    let named = |least: u16| {
        let suspects = diagnose(&narrow(), |_, _, expected| {
            let altered = |(place, &sample): (usize, &u16)| {
                if place % 2 == 0 && sample > least { sample | 64 } else { sample }
            };
            expected.samples().iter().enumerate().map(altered).collect()
        });
        assert!(suspects.iter().all(|other| {
            let Account::Samples { explained, contradicted, .. } = other.account else { return true };
            contradicted < explained
        }));
        suspects.iter().any(Suspect::is_known)
    };
    assert!(named(1000) && !named(2600));
}

/// Whether a memory is faulty is not known of one that explains two fifths.
#[test]
fn no_board_is_given_up_for_a_part_that_explains_little() {
    let technician = |explained: usize, contradicted| {
        let account = Account::Samples { differing: 500, explained, contradicted, others: 0, set_in: false };
        let defect = Defect::KernelDataStuck { weight: "r5".to_owned(), bit: 1, value: 1 };
        let share = explained as f64 / (500 + contradicted) as f64;
        Suspect { defect, account, explained: share }.technician()
    };
    for (explained, contradicted) in [(200, 0), (375, 300)] {
        let told = technician(explained, contradicted);
        assert!(told.ends_with("give the report to the designer."), "{told}");
    }
    assert!(technician(375, 20).contains("cannot be resoldered"));
}

//! Amounts of a report's cloud groups: which rule a station follows, and the cover of each layer by that rule.

use super::super::kinds::CloudAmountRule;

/// Amount of a cloud group, in increasing order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Amount {
    /// FEW: up to 2 eighths of the sky.
    Few,
    /// SCT: 3 or 4 eighths.
    Scattered,
    /// BKN: 5 to 7 eighths.
    Broken,
    /// OVC: the whole sky.
    Overcast,
}

impl Amount {
    /// Returns the middle of the class, eighths.
    fn middle(self) -> f64 {
        match self {
            Self::Few => 1.5,
            Self::Scattered => 3.5,
            Self::Broken => 6.0,
            Self::Overcast => 8.0,
        }
    }

    /// Returns the sky hidden by the layers up to group `nth` of `count` consecutive groups of this class, eighths.
    ///
    /// A single group hides the middle of its class. The sums of several groups divide the class evenly, as the
    /// expected values of ordered random numbers do: nth / (count + 1) of the way from its lower to its upper bound.
    /// Groups of FEW have nothing below them and share the middle in equal parts.
    fn sum(self, nth: usize, count: usize) -> f64 {
        let part = nth as f64 / (count + 1) as f64;
        match self {
            Self::Few => self.middle() * nth as f64 / count as f64,
            Self::Scattered => 3.0 + part,
            Self::Broken => 5.0 + 2.0 * part,
            Self::Overcast => 8.0,
        }
    }
}

/// Cover of a layer whose group gives no amount: a little less than half the sky, as SCT.
const UNKNOWN_COVER: f64 = 3.5 / 8.0;

/// Returns the rule that a station follows, by its location indicator (ICAO Doc 7910). Sums hold in the United States
/// with its territories and in Canada, where indicators begin with K, C, TI, TJ, NSTU, MUGM or P (Alaska, Hawaii and
/// the Pacific islands, without Kiribati's PC and PL). Elsewhere each amount is that of its layer alone. American bases
/// abroad follow their own handbook under the host country's letters, and cannot be recognised.
pub(super) fn rule_of(station: &str) -> CloudAmountRule {
    let under = |prefixes: &[&str]| prefixes.iter().any(|p| station.starts_with(p));
    let american = under(&["K", "C", "P", "TI", "TJ", "NSTU", "MUGM"]) && !under(&["PC", "PL"]);
    if american { CloudAmountRule::Sums } else { CloudAmountRule::Layers }
}

/// Returns the covers of the layers of `groups`, lowest first, 0 to 1; `None` is a group without an amount.
pub(super) fn covers(groups: &[Option<Amount>], rule: CloudAmountRule) -> Vec<f64> {
    if rule == CloudAmountRule::Sums {
        return covers_of_sums(groups);
    }
    groups.iter().map(|g| g.map_or(UNKNOWN_COVER, |a| a.middle() / 8.0)).collect()
}

/// Returns the covers if each group gives the sky that its layer and all lower layers hide together.
///
/// A group of an unknown class, or of a smaller class than some lower group, takes the largest class of the lower
/// groups, because a sum cannot fall. Layers are placed independently of each other (random overlap, as everywhere in
/// Welkin). Of the sky that the layers below leave open, a layer therefore covers (s - below) / (1 - below), with the
/// sum s of its group and the sum `below` of the next lower group. Each cover is above 0, and 1 minus the product of
/// the open shares stays within each group's class. Sums say nothing about a layer above an overcast; such a layer has
/// the middle of its own class.
fn covers_of_sums(groups: &[Option<Amount>]) -> Vec<f64> {
    let mut highest = Amount::Few;
    let classes: Vec<Amount> = groups
        .iter()
        .map(|g| {
            highest = highest.max(g.unwrap_or(highest));
            highest
        })
        .collect();
    let mut below = 0.0;
    let cover = |(i, &class): (usize, &Amount)| {
        let first = classes.partition_point(|c| *c < class);
        let count = classes.partition_point(|c| *c <= class) - first;
        let sum = class.sum(i + 1 - first, count) / 8.0;
        if below >= 1.0 {
            return groups[i].map_or(UNKNOWN_COVER, |a| a.middle() / 8.0);
        }
        let own = (sum - below) / (1.0 - below);
        below = sum;
        own
    };
    classes.iter().enumerate().map(cover).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use {Amount as A, CloudAmountRule as R};

    fn near(got: &[f64], want: &[f64]) {
        let good = got.len() == want.len() && got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(good, "{got:?} where {want:?} is wanted");
    }

    /// Every sequence of up to five groups of any class.
    fn rows() -> Vec<Vec<Option<A>>> {
        let any = [Some(A::Few), Some(A::Scattered), Some(A::Broken), Some(A::Overcast), None];
        let mut all = vec![vec![]];
        for _ in 0..5 {
            let longer: Vec<_> =
                all.iter().flat_map(|row: &Vec<_>| any.map(|a| [row.as_slice(), &[a]].concat())).collect();
            all.extend(longer);
            all.sort_unstable();
            all.dedup();
        }
        all
    }

    #[test]
    fn every_reported_layer_is_there_and_sums_stay_in_their_classes() {
        for row in rows() {
            let covers = covers(&row, R::Sums);
            let (mut open, mut class) = (1.0, A::Few);
            for (cover, amount) in covers.iter().zip(&row) {
                assert!(*cover > 0.0 && *cover <= 1.0, "{row:?}: {covers:?}");
                open *= 1.0 - cover;
                class = class.max(amount.unwrap_or(class));
                let (least, most) = match class {
                    A::Few => (0.0, 2.0),
                    A::Scattered => (3.0, 4.0),
                    A::Broken => (5.0, 7.0),
                    A::Overcast => (8.0, 8.0),
                };
                let eighths = 8.0 * (1.0 - open);
                assert!(eighths > least - 1e-9 && eighths < most + 1e-9, "{row:?}: {covers:?}, {eighths} eighths");
            }
        }
    }

    #[test]
    fn single_groups_are_the_middles_of_their_classes_by_either_rule() {
        for (amount, eighths) in [(A::Few, 1.5), (A::Scattered, 3.5), (A::Broken, 6.0), (A::Overcast, 8.0)] {
            for rule in [R::Sums, R::Layers] {
                near(&covers(&[Some(amount)], rule), &[eighths / 8.0]);
            }
        }
        let rising = [Some(A::Few), Some(A::Scattered), Some(A::Broken)];
        near(&covers(&rising, R::Layers), &[0.1875, 0.4375, 0.75]);
        near(&covers(&rising, R::Sums), &[0.1875, 0.25 / 0.8125, 0.3125 / 0.5625]);
        near(&covers(&[Some(A::Overcast), Some(A::Broken)], R::Layers), &[1.0, 0.75]);
    }

    #[test]
    fn stations_follow_their_nation() {
        for american in
            ["KADW", "K9L2", "CYYZ", "PANC", "PHNL", "PGUM", "PKWA", "PTRO", "PWAK", "TJSJ", "TIST", "NSTU", "MUGM"]
        {
            assert_eq!(rule_of(american), R::Sums, "{american}");
        }
        for other in ["EGLL", "LFPG", "YSSY", "RJTT", "PCIS", "PLCH", "TXKF", "MMMX", "NZAA", "MUHA", "NSFA"] {
            assert_eq!(rule_of(other), R::Layers, "{other}");
        }
    }
}

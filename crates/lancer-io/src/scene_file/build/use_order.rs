//! In which order assets are built: each after those that it uses.

use crate::scene_file::deserialize::Spanned;
use crate::scene_file::model::NodeFile;
use crate::scene_file::syntax::{Place, Problem};
use std::collections::HashMap;

type NamedAsset = (Spanned<String>, Spanned<NodeFile>);

/// The indices of the assets in an order in which each comes after all that it uses, and a problem for each cycle.
///
/// A `use` that closes a cycle is passed over. Nothing here recurses over assets, of which one may use the next a
/// hundred thousand times over.
pub(super) fn use_order(assets: &[NamedAsset]) -> (Vec<usize>, Vec<Problem>) {
    let indices = assets
        .iter()
        .enumerate()
        .map(|(index, (name, _))| (name.value.as_str(), index))
        .collect::<HashMap<_, _>>();
    let mut search = Search {
        assets,
        marks: vec![Mark::New; assets.len()],
        order: Vec::with_capacity(assets.len()),
        cycles: Vec::new(),
    };
    let uses_of = |index: usize| uses(&assets[index].1.value, &indices);
    for index in 0..assets.len() {
        if search.marks[index] == Mark::New {
            search.visit(index, uses_of);
        }
    }
    (search.order, search.cycles)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    /// On the path from where the search began.
    Open,
    Done,
}

struct Search<'a> {
    assets: &'a [NamedAsset],
    marks: Vec<Mark>,
    order: Vec<usize>,
    cycles: Vec<Problem>,
}

/// A mention of an asset.
type Use = (usize, Place);

impl Search<'_> {
    /// Depth-first from an asset.
    fn visit(&mut self, start: usize, uses_of: impl Fn(usize) -> Vec<Use>) {
        let mut path = vec![(start, uses_of(start))];
        self.marks[start] = Mark::Open;
        while let Some((index, rest)) = path.last_mut() {
            let Some((used, place)) = rest.pop() else {
                self.marks[*index] = Mark::Done;
                self.order.push(*index);
                path.pop();
                continue;
            };
            match self.marks[used] {
                Mark::Done => {}
                Mark::New => {
                    self.marks[used] = Mark::Open;
                    path.push((used, uses_of(used)));
                }
                Mark::Open => {
                    let cycle = path.iter().map(|&(index, _)| index).skip_while(|&index| index != used);
                    self.cycles.push(self.cycle(&cycle.collect::<Vec<_>>(), place));
                }
            }
        }
    }

    fn cycle(&self, indices: &[usize], place: Place) -> Problem {
        let name = |&index: &usize| format!("`{}`", self.assets[index].0.value);
        let first = name(&indices[0]);
        let mut names = indices.iter().take(NAMES_TOLD).map(name).collect::<Vec<_>>();
        if indices.len() > NAMES_TOLD {
            names.push("...".into());
        }
        let round = names.join(" uses ");
        Problem::new(place, format!("an asset cannot hold itself: {round} uses {first}"))
    }
}

/// Names of a cycle that a message tells: a terminal's line or so.
const NAMES_TOLD: usize = 8;

/// The assets that an object uses, first mention last.
fn uses(object: &NodeFile, indices: &HashMap<&str, usize>) -> Vec<Use> {
    let mut found = Vec::new();
    collect_uses(object, indices, &mut found);
    found.reverse();
    found
}

fn collect_uses(object: &NodeFile, indices: &HashMap<&str, usize>, found: &mut Vec<Use>) {
    if let Some(asset) = &object.asset {
        found.extend(indices.get(asset.value.as_str()).map(|&index| (index, asset.place)));
    }
    for child in object.children.iter().flatten() {
        collect_uses(&child.value, indices, found);
    }
}

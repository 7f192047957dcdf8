//! What looks wrong with a scene that can be read, and the numbers that tell how hard it is.
//!
//! A scene may be right in form and still not be what was meant: millimetres for metres, a column that buckles, supports out of reach. What is
//! found is a [`Remark`] at its line. [`Scene::remarks`] looks at the numbers alone; [`Scene::check`] solves each rod twice as well, to say
//! how large the error of its mesh is.

mod buckling;
mod effect;
mod mesh;
mod numbers;
mod reach;
mod trial;
mod units;

pub use numbers::{Numbers, Tension};
pub use trial::{Fault, Trial};

use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{RodFile, SectionFile, SectionsFile};
use crate::model::ModelRod;
use crate::{MeshChoice, Scene};
use strands::rod::Order;
use strands::statics::{Plan, plan};

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Probably a slip, or an answer that cannot be relied on.
    Warning,
    /// Good to know.
    Note,
}

/// Something about a scene that its author may not have meant.
#[derive(Clone, Debug)]
pub struct Remark {
    /// How much it matters.
    pub level: Level,
    /// What it is, at its line and key, and how to mend it.
    pub said: SceneError,
}

/// What is known of a scene before it is used.
#[derive(Clone, Debug)]
pub struct Check {
    /// Each rod, in the order of the file.
    pub rods: Vec<RodCheck>,
    /// What looks wrong, warnings first.
    pub remarks: Vec<Remark>,
}

/// What is known of a rod before it is used.
#[derive(Clone, Debug)]
pub struct RodCheck {
    /// Its name.
    pub name: String,
    /// Its sizes, stiffnesses and loads, and what follows from them.
    pub numbers: Numbers,
    /// How many elements it has. Where the mesh is chosen for a tolerance, those of the mesh that was found.
    pub elements: usize,
    /// The order of its elements.
    pub order: Order,
    /// The shortest and the longest element, m.
    pub element_lengths: [f64; 2],
    /// Which solver a solve takes first, and why.
    pub plan: Plan,
    /// What a trial found.
    pub trial: Trial,
}

impl Scene {
    /// What looks wrong, found without solving anything; warnings first.
    pub fn remarks(&self) -> Vec<Remark> {
        let mut remarks = self.slips();
        let slipped = remarks.warned();
        for view in self.views() {
            reach::look(&mut remarks, &view);
            // What follows from a slip is not worth a word of its own.
            if !slipped {
                reach::look_at_loads(&mut remarks, &view);
                // What ties it holds it too, and so does what it touches.
                if !view.rod.is_tied() && self.model.surfaces.is_none() {
                    buckling::look(&mut remarks, &view);
                }
                mesh::look(&mut remarks, &view);
            }
            effect::look_at_rod(&mut remarks, &view);
        }
        effect::look(&mut remarks, &self.file, &self.model);
        remarks.sorted()
    }

    /// The same, with the numbers of each rod and what two solves of it tell.
    pub fn check(&self) -> Check {
        let slipped = self.slips().warned();
        let mut remarks = Remarks { list: self.remarks(), ..Remarks::of(&self.document) };
        let mut rods = Vec::with_capacity(self.model.rods.len());
        for view in self.views() {
            let (rod, settings, trial) = trial::trial(&self.model, view.rod);
            let view = View { rod: &rod, ..view };
            let mut numbers = Numbers::expected(&view);
            if let Trial::Solved { tension, .. } = trial {
                numbers.tension = Tension { value: tension, found: true };
            }
            if !slipped {
                trial::look(&mut remarks, &view, &numbers, &trial);
            }
            let mesh = &rod.problem.rod;
            rods.push(RodCheck {
                name: rod.name.clone(),
                elements: mesh.elements(),
                order: mesh.order(),
                element_lengths: mesh::element_lengths(mesh),
                plan: plan(&rod.problem, &settings, None),
                numbers,
                trial,
            });
        }
        Check { rods, remarks: remarks.sorted() }
    }

    /// Numbers that are off by a thousand.
    fn slips(&self) -> Remarks<'_> {
        let mut remarks = Remarks::of(&self.document);
        units::look(&mut remarks, &self.file);
        self.views().for_each(|view| units::look_at_rod(&mut remarks, &view));
        remarks
    }

    fn views(&self) -> impl Iterator<Item = View<'_>> {
        self.model.rods.iter().filter_map(|rod| {
            Some(View { file: self.file.rods.get(&rod.name)?, path: KeyPath::of("rods").key(&rod.name), rod })
        })
    }
}

/// A rod as written, where, and as understood.
struct View<'a> {
    file: &'a RodFile,
    path: KeyPath,
    rod: &'a ModelRod,
}

impl View<'_> {
    /// Its sections with their places in the file; none where its stiffness is given.
    fn sections(&self) -> Vec<(KeyPath, &SectionFile)> {
        let path = self.path.key("section");
        match &self.file.section {
            None => Vec::new(),
            Some(SectionsFile::One(section)) => vec![(path, section)],
            Some(SectionsFile::Stations(list)) => {
                list.iter().enumerate().map(|(i, section)| (path.index(i), section)).collect()
            }
        }
    }

    /// The key that decides how fine the mesh is.
    fn mesh_key(&self) -> KeyPath {
        self.path.key(match self.rod.mesh {
            MeshChoice::Elements(_) => "elements",
            MeshChoice::Tolerance(_) => "tolerance",
        })
    }

    /// The key of the support that holds a place.
    fn support_key(&self, s: f64) -> KeyPath {
        let length = self.rod.problem.rod.length();
        let here = |at: f64| (at - s).abs() <= 1e-9 * length;
        let supports = self.path.key("supports");
        let found =
            self.file.supports.iter().enumerate().filter(|(_, support)| here(support.at.metres(length)));
        match found.max_by_key(|(_, support)| support.position.is_some()) {
            Some((i, support)) if support.position.is_some() => supports.index(i).key("position"),
            Some((i, _)) => supports.index(i),
            None => supports,
        }
    }
}

/// Remarks as they are made.
struct Remarks<'a> {
    document: &'a Document,
    list: Vec<Remark>,
}

impl<'a> Remarks<'a> {
    fn of(document: &'a Document) -> Self {
        Self { document, list: Vec::new() }
    }

    fn warn(&mut self, path: &KeyPath, message: String, mend: impl Into<String>) {
        self.add(Level::Warning, path, message, mend);
    }

    fn note(&mut self, path: &KeyPath, message: String, mend: impl Into<String>) {
        self.add(Level::Note, path, message, mend);
    }

    fn add(&mut self, level: Level, path: &KeyPath, message: String, mend: impl Into<String>) {
        self.list.push(Remark { level, said: self.document.error(path, message).mend(mend) });
    }

    fn warned(&self) -> bool {
        self.list.iter().any(|remark| remark.level == Level::Warning)
    }

    fn sorted(mut self) -> Vec<Remark> {
        self.list.sort_by_key(|remark| remark.level == Level::Note);
        self.list
    }
}

impl Remark {
    /// The remark as text for a terminal, with its line marked.
    pub fn render(&self, colour: bool) -> String {
        self.said.render_as(
            match self.level {
                Level::Warning => annotate_snippets::Level::WARNING,
                Level::Note => annotate_snippets::Level::NOTE,
            },
            colour,
        )
    }
}

impl Level {
    /// Its name in answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// A number to three digits.
fn short(x: f64) -> String {
    if x == 0.0 || !(1e-3..1e5).contains(&x.abs()) {
        return format!("{x:.2e}").replace(".00e", "e").replace("0e0", "0");
    }
    let decimals = (2 - x.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A length, m, to three digits in the unit that reads best.
fn metres(x: f64) -> String {
    let (factor, unit) = match x.abs() {
        size if size == 0.0 || size >= 1.0 => (1.0, "m"),
        size if size >= 1e-3 => (1e3, "mm"),
        _ => (1e6, "µm"),
    };
    format!("{} {unit}", short(x * factor))
}

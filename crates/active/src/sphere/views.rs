//! Static views, to train recognisers on.

use opendr_engine::{Error, Random, Result, map_in_order};
use opendr_simulation::sphere_view::{Asset, Conditions, SphereWorld, Subject};

/// Rendered views with their labels.
#[derive(Debug, Clone)]
pub struct ViewSet {
    /// Pixels in each direction.
    pub side: usize,
    /// `[views, height, width, 3]` RGB bytes.
    pub pixels: Vec<u8>,
    /// Class of each view, from 0.
    pub labels: Vec<usize>,
    /// Number of classes.
    pub classes: usize,
}

/// Views of one generated subject.
const VIEWS: usize = 15;
/// Share of views from within 75 degrees of the front; the others are from anywhere.
const FRONTAL: f32 = 0.7;

impl ViewSet {
    /// Renders `subjects` subjects, class after class, from 15 places each, on `threads` threads. Persons are the ten from
    /// number `first` on; of objects and figures the subjects are instances from number `first` on.
    ///
    /// # Errors
    /// None for numbers of subjects that fit into memory.
    pub fn render(
        subject: Subject,
        side: usize,
        first: u32,
        subjects: usize,
        threads: usize,
    ) -> Result<Self> {
        let classes = subject.classes() as usize;
        let mut set = Self { side, pixels: Vec::new(), labels: Vec::new(), classes };
        let persons: Vec<Asset> = match subject {
            Subject::Face => (first..first + classes as u32)
                .map(|person| Asset::generate(subject, person, 0))
                .collect::<Result<_>>()?,
            Subject::Object | Subject::Pose => Vec::new(),
        };
        let mut worlds = (0..threads.max(1)).map(|_| SphereWorld::new(side)).collect::<Result<Vec<_>>>()?;
        let work = |world: &mut SphereWorld, number: usize| -> Result<(usize, Vec<u8>)> {
            let label = number % classes;
            let (class, instance) = match subject {
                Subject::Face => (first + label as u32, 0),
                Subject::Object | Subject::Pose => {
                    (label as u32, u64::from(first) + (number / classes) as u64)
                }
            };
            let asset = match persons.get(label) {
                Some(person) => person.clone(),
                None => Asset::generate(subject, class, instance)?,
            };
            let mut random = Random::from_key([u64::from(first), number as u64, 0x71e3]);
            let mut pixels = vec![0; VIEWS * 3 * side * side];
            for view in pixels.chunks_exact_mut(3 * side * side) {
                let mut conditions = Conditions::draw(&mut random);
                if random.chance(FRONTAL) {
                    let azimuth = f64::from(random.uniform(-1.3, 1.3));
                    conditions.occluder = conditions.occluder.map(|at| at - conditions.azimuth + azimuth);
                    conditions.azimuth = azimuth;
                }
                world.begin(&asset, &conditions, random.bits())?;
                world.capture_into(view);
            }
            Ok((label, pixels))
        };
        map_in_order(&mut worlds, 0..subjects, work, |rendered| {
            let (label, pixels) = rendered?;
            set.pixels.extend(pixels);
            set.labels.extend([label; VIEWS]);
            Ok::<_, Error>(())
        })?;
        Ok(set)
    }

    /// Number of views.
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    pub(super) fn view(&self, at: usize) -> &[u8] {
        let size = 3 * self.side * self.side;
        &self.pixels[at * size..(at + 1) * size]
    }
}

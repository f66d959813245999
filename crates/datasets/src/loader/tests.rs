use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use opendr_engine::data::Image;
use opendr_engine::dataset::{Dataset, Sample};
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{ErrorKind, Value};
use opendr_vision::Preprocess;

use super::*;
use crate::augment::{Blur, Colour, Flip, Mosaic, PixelNoise, RandomResizedCrop, Rotate};

const THREADS: [usize; 4] = [0, 1, 2, 4];

/// Images with distinct pixels, and a counter of reads.
struct Pictures {
    count: usize,
    broken: Vec<usize>,
    panics: Option<usize>,
    read: Arc<AtomicUsize>,
}

impl Pictures {
    fn new(count: usize) -> Self {
        Self { count, broken: Vec::new(), panics: None, read: Arc::default() }
    }
}

impl Dataset for Pictures {}

impl DatasetIterator for Pictures {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.read.fetch_add(1, Ordering::SeqCst);
        assert_ne!(self.panics, Some(index), "sample {index} is a trap");
        if self.broken.contains(&index) {
            return Err(Error::format("cut off"));
        }
        let pixels = (0..48 * 36 * 3).map(|at| (at * (index + 3) / 5) as u8).collect();
        let found = BoundingBox::new(index as i64, 5.0, 5.0, 30.0, 20.0, 1.0);
        Ok(Sample {
            data: vec![Image::from_rgb8(pixels, 48, 36).unwrap().into()],
            target: Some(BoundingBoxList::from(vec![found]).into()),
        })
    }
}

fn options(threads: usize) -> LoaderOptions {
    LoaderOptions { batch_size: 4, threads, prefetch: 3, seed: 11, ..LoaderOptions::default() }
}

fn loader(pictures: Pictures, threads: usize) -> Loader<'static> {
    Loader::new(pictures, options(threads)).unwrap()
}

fn indices<C: Collate>(epoch: Epoch<C>) -> Vec<usize> {
    epoch.flat_map(|batch| batch.unwrap().indices).collect()
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let run = |threads: usize| -> Vec<(Vec<usize>, Vec<Sample>)> {
        let pipeline = Pipeline::default()
            .sometimes(0.3, Mosaic { width: 60, height: 50, ..Default::default() })
            .and_then(|steps| steps.then(RandomResizedCrop { width: 32, height: 24, ..Default::default() }))
            .and_then(|steps| steps.sometimes(0.5, Flip::default()))
            .and_then(|steps| steps.sometimes(0.5, Rotate::default()))
            .and_then(|steps| steps.sometimes(0.8, Colour::default()))
            .and_then(|steps| steps.sometimes(0.5, Blur::default()))
            .and_then(|steps| steps.then(PixelNoise::default()));
        let loader = loader(Pictures::new(22), threads).augment(pipeline.unwrap());
        let both = [loader.epoch(0), loader.epoch(1)];
        both.into_iter()
            .flatten()
            .map(|batch| batch.unwrap())
            .map(|batch| (batch.indices, batch.content))
            .collect()
    };
    let wanted = run(0);
    assert_eq!(wanted.len(), 12);
    for threads in [1, 2, 4] {
        assert!(run(threads) == wanted, "{threads} threads");
    }
}

#[test]
fn epochs_have_all_samples_in_different_orders() {
    for threads in THREADS {
        let loader = loader(Pictures::new(22), threads);
        let [first, second] = [0, 1].map(|epoch| indices(loader.epoch(epoch)));
        assert_eq!(first, indices(loader.epoch(0)));
        assert_ne!(first, second);
        let mut sorted = first.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..22).collect::<Vec<_>>());
        assert_eq!((loader.batches(), loader.samples()), (6, 22));
    }
    let plain = LoaderOptions { shuffle: false, drop_last: true, ..options(2) };
    let loader = Loader::new(Pictures::new(22), plain).unwrap();
    assert_eq!(indices(loader.epoch(0)), (0..20).collect::<Vec<_>>());
    assert_eq!(Loader::new(Pictures::new(0), options(2)).unwrap().epoch(0).count(), 0);
}

#[test]
fn an_epoch_resumes_at_its_position() {
    let loader =
        loader(Pictures::new(22), 2).augment(Pipeline::default().then(PixelNoise::default()).unwrap());
    let whole: Vec<_> = loader.epoch(3).map(|batch| batch.unwrap()).collect();
    let position = whole[1].next_position;
    assert_eq!(position, 8);
    let rest: Vec<_> = loader.resume(3, position).unwrap().map(|batch| batch.unwrap()).collect();
    assert_eq!(rest.len(), 4);
    for (one, other) in rest.iter().zip(&whole[2..]) {
        assert_eq!((&one.indices, one.next_position), (&other.indices, other.next_position));
        assert!(one.content == other.content);
    }
    assert_eq!(loader.resume(3, 22).unwrap().count(), 0);
    assert_eq!(loader.resume(3, 23).err().unwrap().kind(), ErrorKind::InvalidInput);
}

#[test]
fn shares_divide_the_batches_and_read_only_their_own() {
    for (threads, position) in [(0, 0), (2, 0), (2, 8)] {
        let whole: Vec<_> = loader(Pictures::new(22), threads).resume(3, position).unwrap().collect();
        let whole: Vec<_> = whole.into_iter().map(|batch| batch.unwrap()).collect();
        for rank in 0..4 {
            let pictures = Pictures::new(22);
            let read = Arc::clone(&pictures.read);
            let share = loader(pictures, threads).share(rank, 4).unwrap();
            let batches: Vec<_> = share.resume(3, position).unwrap().map(|batch| batch.unwrap()).collect();
            let wanted: Vec<_> = whole.iter().skip(rank).step_by(4).collect();
            assert_eq!(batches.len(), wanted.len(), "share {rank} from {position} on");
            for (one, other) in batches.iter().zip(wanted) {
                assert_eq!((&one.indices, one.next_position), (&other.indices, other.next_position));
                assert!(one.content == other.content);
            }
            assert_eq!(
                read.load(Ordering::SeqCst),
                batches.iter().map(|batch| batch.indices.len()).sum::<usize>()
            );
        }
    }
    let error = loader(Pictures::new(22), 0).share(2, 2).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
}

#[test]
fn reading_ahead_is_bounded_and_ends_when_dropped() {
    for threads in [1, 2, 4] {
        let pictures = Pictures::new(4000);
        let read = Arc::clone(&pictures.read);
        let loader = loader(pictures, threads);
        let mut epoch = loader.epoch(0);
        for handed in 1..=40 {
            epoch.next().unwrap().unwrap();
            // The training is slow: without a bound, the threads would read ahead.
            std::thread::yield_now();
            assert!(read.load(Ordering::SeqCst) <= (handed + 3) * 4);
        }
        drop(epoch);
        let after = read.load(Ordering::SeqCst);
        assert!(after <= (40 + 3) * 4);
        // The threads were joined: only the loader still holds the shared data.
        assert_eq!(Arc::strong_count(&loader.dataset), 1);
        assert_eq!(read.load(Ordering::SeqCst), after);
    }
}

#[test]
fn broken_samples_are_errors_in_place_or_skipped_and_listed() {
    for threads in THREADS {
        let pictures = || Pictures { broken: vec![5, 12, 13, 14, 15], ..Pictures::new(22) };
        let plain = LoaderOptions { shuffle: false, ..options(threads) };
        let strict = Loader::new(pictures(), plain.clone()).unwrap();
        let outcomes: Vec<bool> = strict.epoch(0).map(|batch| batch.is_ok()).collect();
        assert_eq!(outcomes, [true, false, true, false, true, true]);
        let error = strict.epoch(0).find_map(Result::err).unwrap();
        assert_eq!(error.to_string(), "sample 5 (5): cut off");
        let lenient = Loader::new(pictures(), LoaderOptions { skip_broken: true, ..plain }).unwrap();
        let mut epoch = lenient.epoch(0);
        let kept: Vec<usize> = epoch.by_ref().flat_map(|batch| batch.unwrap().indices).collect();
        assert_eq!(kept, [0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 20, 21]);
        let skipped: Vec<usize> = epoch.skipped().iter().map(|one| one.index).collect();
        assert_eq!(skipped, [5, 12, 13, 14, 15]);
    }
}

#[test]
fn a_panic_resumes_in_place_of_its_batch() {
    for threads in THREADS {
        let pictures = Pictures { panics: Some(9), ..Pictures::new(22) };
        let loader = Loader::new(pictures, LoaderOptions { shuffle: false, ..options(threads) }).unwrap();
        let mut epoch = loader.epoch(0);
        assert!(epoch.next().unwrap().is_ok() && epoch.next().unwrap().is_ok());
        assert!(catch_unwind(AssertUnwindSafe(|| epoch.next())).is_err());
        assert_eq!(epoch.next().unwrap().unwrap().indices, [12, 13, 14, 15]);
    }
}

#[test]
fn batches_of_images_are_tensors() {
    let scaling = Preprocess::new(24, 18).normalise([0.0; 3], [255.0; 3]);
    let loader = loader(Pictures { broken: vec![3], ..Pictures::new(10) }, 2);
    let loader = Loader { options: LoaderOptions { skip_broken: true, ..loader.options.clone() }, ..loader }
        .collate(ImageBatches::new(scaling.clone()));
    let mut seen = 0;
    for batch in loader.epoch(0).chain(loader.epoch(1)) {
        let Batch { content, indices, .. } = batch.unwrap();
        assert_eq!(content.shape(), [indices.len(), 3, 18, 24]);
        assert_eq!(content.targets().len(), indices.len());
        for (place, index) in indices.iter().enumerate() {
            let Value::Image(image) = &Pictures::new(10).get(*index).unwrap().data[0] else { panic!() };
            let mut wanted = vec![0f32; scaling.len()];
            scaling.run_into(image.view(), &mut wanted).unwrap();
            assert_eq!(&content.values()[place * wanted.len()..][..wanted.len()], &wanted[..]);
            assert_eq!(content.geometries()[place].image_from_input([12.0, 9.0]), [24.0, 18.0]);
            let Some(Value::BoundingBoxList(list)) = &content.targets()[place] else { panic!() };
            assert_eq!(list.boxes[0].name, (*index as i64).into());
        }
        seen += indices.len();
    }
    assert_eq!(seen, 18);
}

#[test]
fn options_out_of_range_are_errors() {
    let wrong = LoaderOptions { batch_size: 0, ..LoaderOptions::default() };
    assert_eq!(Loader::new(Pictures::new(3), wrong).err().unwrap().kind(), ErrorKind::InvalidParam);
}

#[test]
fn borrowed_data_sets_are_loaded_too() {
    for threads in THREADS {
        let pictures = Pictures { broken: vec![2], ..Pictures::new(22) };
        let lenient = LoaderOptions { skip_broken: true, ..options(threads) };
        let loader = Loader::new(&pictures as &dyn DatasetIterator, lenient).unwrap();
        let mut seen = Vec::new();
        let skipped = loader.for_each(1, 4, |batch| {
            seen.extend(batch.indices);
            Ok(ControlFlow::Continue(()))
        });
        let mut wanted = loader.order(1)[4..].to_vec();
        assert_eq!(skipped.unwrap().len(), wanted.iter().filter(|index| **index == 2).count());
        wanted.retain(|index| *index != 2);
        assert_eq!(seen, wanted);
        // Neither an error nor a panic of the training leaves threads behind.
        let enough = loader.for_each(0, 0, |_| Err(Error::invalid_input("enough")));
        assert_eq!(enough.unwrap_err().message(), "enough");
        let panic = catch_unwind(AssertUnwindSafe(|| loader.for_each(0, 0, |_| panic!("enough"))));
        assert!(panic.is_err() && Arc::strong_count(&loader.dataset) == 1);
        assert_eq!(
            loader.for_each(0, 23, |_| Ok(ControlFlow::Continue(()))).unwrap_err().kind(),
            ErrorKind::InvalidInput
        );
    }
}

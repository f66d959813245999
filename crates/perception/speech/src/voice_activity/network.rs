//! Silero's network over a stream.

use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorInfo, TensorView};

/// Samples a second that the network knows.
pub const SAMPLE_RATE: u32 = 16_000;
/// Samples of a chunk, each with a probability.
pub const CHUNK: usize = 512;
/// Samples before a chunk that the network sees too.
const CONTEXT: usize = 64;
/// Numbers that the network remembers from chunk to chunk.
const MEMORY: [usize; 3] = [2, 1, 128];

/// A loaded network: `input` `[1, 576]` and `state` `[2, 1, 128]` to `output` `[1, 1]` and `stateN`.
pub struct VoiceNetwork {
    session: Session,
    probability: usize,
    memory: usize,
}

/// What a stream of sound remembers: the network's memory and less than a chunk of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct VoiceStream {
    /// Context, then the samples of the chunk that is not whole yet.
    samples: Vec<f32>,
    memory: Vec<f32>,
}

impl Default for VoiceStream {
    fn default() -> Self {
        Self { samples: vec![0.0; CONTEXT], memory: vec![0.0; MEMORY.iter().product()] }
    }
}

impl VoiceNetwork {
    /// Opens the network.
    ///
    /// # Errors
    /// `Format` when the bytes are another model, `Device` when the device is not there.
    pub fn open(model: &[u8], device: Device) -> Result<Self> {
        let session = Session::open(model, device)?;
        let takes = |input: Option<&TensorInfo>, shape: &[usize]| {
            input.is_some_and(|input| {
                input.dims.len() == shape.len()
                    && input.dims.iter().zip(shape).all(|(dim, size)| dim.is_none_or(|dim| dim == *size))
            })
        };
        let inputs = session.inputs();
        let fits = inputs.len() == 2
            && takes(inputs.first(), &[1, CONTEXT + CHUNK])
            && takes(inputs.get(1), &MEMORY);
        if !fits {
            return Err(Error::format(
                "the model takes no 576 samples with a state of 2x1x128; give Silero's network for 16 kHz, version 5 or 6",
            ));
        }
        let (probability, memory) = (session.output_index("output")?, session.output_index("stateN")?);
        Ok(Self { session, probability, memory })
    }

    /// Takes the next samples of a stream, of any number, at [`SAMPLE_RATE`], and hands on the probability of speech, 0..=1,
    /// in each chunk of [`CHUNK`] that they complete.
    ///
    /// # Errors
    /// Whatever the runtime or `each` fails with.
    pub fn push(
        &self,
        stream: &mut VoiceStream,
        mut samples: &[f32],
        mut each: impl FnMut(f32) -> Result<()>,
    ) -> Result<()> {
        loop {
            let wanted = (CONTEXT + CHUNK - stream.samples.len()).min(samples.len());
            let (now, later) = samples.split_at(wanted);
            stream.samples.extend_from_slice(now);
            samples = later;
            if stream.samples.len() < CONTEXT + CHUNK {
                return Ok(());
            }
            each(self.chunk(stream)?)?;
        }
    }

    /// The probability of what is left when the stream ends, filled up with silence; `None` when nothing is left. The stream
    /// begins anew after.
    ///
    /// # Errors
    /// Whatever the runtime fails with.
    pub fn flush(&self, stream: &mut VoiceStream) -> Result<Option<f32>> {
        let left = stream.samples.len() > CONTEXT;
        stream.samples.resize(CONTEXT + CHUNK, 0.0);
        let last = if left { Some(self.chunk(stream)?) } else { None };
        *stream = VoiceStream::default();
        Ok(last)
    }

    fn chunk(&self, stream: &mut VoiceStream) -> Result<f32> {
        let VoiceStream { samples, memory } = stream;
        let mut probability = 0.0;
        let input = TensorView::new(&[1, CONTEXT + CHUNK], &samples[..])?;
        // What is remembered is replaced while the session still reads it elsewhere, so by way of a copy on the stack.
        let mut next = [0.0; MEMORY[0] * MEMORY[1] * MEMORY[2]];
        self.session.run(&[input, TensorView::new(&MEMORY, &memory[..])?], |outputs| {
            let wrong = || Error::format("the network gives no probability and state");
            let output = |index: usize| outputs.get(index).ok_or_else(wrong)?.values::<f32>();
            probability = *output(self.probability)?.first().ok_or_else(wrong)?;
            let memory = output(self.memory)?;
            if memory.len() != next.len() {
                return Err(wrong());
            }
            next.copy_from_slice(memory);
            Ok(())
        })?;
        memory.clear();
        memory.extend_from_slice(&next);
        samples.drain(..CHUNK);
        Ok(probability)
    }
}

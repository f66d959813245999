//! Silero's network on a stream.

use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorInfo, TensorView};

/// Sample rate of the network in Hz.
pub const SAMPLE_RATE: u32 = 16_000;
/// Samples per chunk; each chunk has a probability.
pub const CHUNK: usize = 512;
/// Samples before a chunk that are part of the network's input.
const CONTEXT: usize = 64;
/// Shape of the network's recurrent state.
const MEMORY: [usize; 3] = [2, 1, 128];

/// A loaded network: `input` `[1, 576]` and `state` `[2, 1, 128]` to `output` `[1, 1]` and `stateN`.
pub struct VoiceNetwork {
    session: Session,
    probability: usize,
    memory: usize,
}

/// State of a stream of audio: the network's recurrent state and less than a chunk of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct VoiceStream {
    /// Context, then the samples of the incomplete chunk.
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
    /// `Format` when the bytes are another model, `Device` when the device is not available.
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
                "the model does not take 576 samples and a state of 2x1x128; use Silero's network for 16 kHz, version 5 or 6",
            ));
        }
        let (probability, memory) = (session.output_index("output")?, session.output_index("stateN")?);
        Ok(Self { session, probability, memory })
    }

    /// Adds any number of samples at [`SAMPLE_RATE`] and passes the speech probability, 0..=1, of each completed chunk of
    /// [`CHUNK`] samples to `each`.
    ///
    /// # Errors
    /// The errors of the runtime and of `each`.
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

    /// Ends the stream and resets it. Returns the probability of the remaining samples, padded with silence; `None` when none
    /// remain.
    ///
    /// # Errors
    /// The errors of the runtime.
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
        // The session still borrows the state while the new one is read, so it is copied to the stack first.
        let mut next = [0.0; MEMORY[0] * MEMORY[1] * MEMORY[2]];
        self.session.run(&[input, TensorView::new(&MEMORY, &memory[..])?], |outputs| {
            let wrong = || Error::format("the network does not return a probability and a state");
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

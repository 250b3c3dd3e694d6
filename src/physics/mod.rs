//! Flight, contact and the equations of Nagurka and Huang. Knows nothing of audio.

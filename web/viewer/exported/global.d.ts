/** The recording of an exported page, which the loader passes to the player. */
interface Window {
  vatRecording?: Blob;
}

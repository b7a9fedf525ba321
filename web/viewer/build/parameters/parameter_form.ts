import type { MethodName, Params, Scene } from '../../../client/index';

/** A form of the section for the scene's constants. */
export interface ParameterForm {
  readonly element: HTMLElement;
  enable(enabled: boolean): void;
  /** `initial` is the scene as it was loaded. */
  show(scene: Scene, initial: Scene): void;
}

/**
 * Executes a change after all earlier ones, and displays the result. `make` is called when the form
 * shows the results of the earlier changes; undefined: there is nothing to change any more. Returns an
 * error text if the change was rejected.
 */
export type Change<M extends MethodName> = (
  make: () => Params<M> | undefined,
) => Promise<string | undefined>;

import type { MethodName, Params, Scene } from '../../../client/index';

/** A form of the section for the scene's constants. */
export interface ParameterForm {
  readonly element: HTMLElement;
  enable(enabled: boolean): void;
  /** `initial` is the scene as it was loaded. */
  show(scene: Scene, initial: Scene): void;
}

/** Executes a change and displays the result. Returns an error text if it was rejected. */
export type Change<M extends MethodName> = (params: Params<M>) => Promise<string | undefined>;

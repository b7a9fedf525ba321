/** Functions of browsers and Node. The client uses no other functions of its host. */
declare function setTimeout(callback: () => void, milliseconds: number): number;
declare function clearTimeout(timer: number | undefined): void;
declare class TextDecoder {
  constructor(label: string, options: { fatal: boolean });
  decode(bytes: ArrayBuffer): string;
}

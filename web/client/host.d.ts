/** The timers of browsers and Node. The client uses no other function of its host. */
declare function setTimeout(callback: () => void, milliseconds: number): number;
declare function clearTimeout(timer: number | undefined): void;

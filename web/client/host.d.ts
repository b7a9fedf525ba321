/** The timers that browsers and Node have alike; the client needs nothing else of its host. */
declare function setTimeout(callback: () => void, milliseconds: number): number;
declare function clearTimeout(timer: number | undefined): void;

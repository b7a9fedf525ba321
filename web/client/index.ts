/** Client of the vat.v1 protocol for browsers and Node: no DOM, the WebSocket is handed in. */
export * from './clock';
export * from './connection';
export * from './frame';
export * from './messages';
export * from './requests';
export * from './session';
export * from './socket';

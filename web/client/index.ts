/** Client of the vat.v1 protocol for browsers and Node: without DOM. The caller supplies the WebSocket. */
export * from './clock.js';
export * from './connection.js';
export * from './frame.js';
export * from './messages.js';
export * from './recording.js';
export * from './requests.js';
export * from './session.js';
export * from './socket.js';

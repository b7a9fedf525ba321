"""vat: simulation of liquids, deformable and rigid bodies, in this process and on servers."""

from vat.async_client import AsyncClient
from vat.client import Client
from vat.errors import Fault, InputError, StepError
from vat.exchange import VatError
from vat.frames import Frame, FrameBody, FrameDecoder, frame_number
from vat.recording import Recording
from vat.results import Advance, BodyDiagnostics, Diagnostics, Event, Pose
from vat.scenes import load_scene, scene_names
from vat.session import Session
from vat.simulation import Body, Grab, Simulation
from vat.websocket import Closed

__all__ = [
    "Advance", "AsyncClient", "Body", "BodyDiagnostics", "Client", "Closed", "Diagnostics", "Event",
    "Fault", "Frame", "FrameBody", "FrameDecoder", "Grab", "InputError", "Pose", "Recording",
    "Session", "Simulation",
    "StepError", "VatError", "frame_number", "load_scene", "scene_names"]

"""The judge: what of a home works. It knows plans, assets and geometry, and nothing of how homes are made."""

from pipeline.verify.certificate import Certificate, JointCheck, ObjectCheck, RoomCheck
from pipeline.verify.home import verify_home
from pipeline.verify.settings import Policy, VerifySettings

__all__ = ["Certificate", "JointCheck", "ObjectCheck", "Policy", "RoomCheck", "VerifySettings", "verify_home"]

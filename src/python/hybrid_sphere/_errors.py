"""The exceptions of hybrid_sphere. No numpy, no compiled code: they are there for whoever only wants to catch them."""


class SceneError(ValueError):
    """A scene, or something that is to become a part of one, is refused; nothing has changed.

    key      path of what is refused, as in a scene file: "surface.regions[2].circle.radius"; empty where the source
             cannot be read at all
    value    what was found there, as text; empty where it is missing
    allowed  what is allowed instead, with its unit
    """

    def __init__(self, message, key="", value="", allowed=""):
        super().__init__(message)
        self.key = key
        self.value = value
        self.allowed = allowed

    def __reduce__(self):
        return type(self), (str(self), self.key, self.value, self.allowed)


class Halted(RuntimeError):
    """A motion cannot be computed further; it stays where it is.

    reason  why, in a word, such as "accumulation" (switches that follow one another ever faster)
    time    when [s]
    states  what run() had computed before that, None elsewhere
    """

    def __init__(self, message, reason="", time=0.0, states=None):
        super().__init__(message)
        self.reason = reason
        self.time = time
        self.states = states

    def __reduce__(self):
        return type(self), (str(self), self.reason, self.time, self.states)

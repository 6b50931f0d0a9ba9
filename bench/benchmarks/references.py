"""Reference motions of the benchmark problems of IFToMM's library, by methods that share nothing with the engine.

`pendulum` and `four_bars` are closed forms with Jacobi's elliptic functions. `squeezer`, `bricard` and `governor` integrate a
minimal or nearly minimal set of coordinates with scipy (DOP853 or Radau, relative tolerance 1e-12). Each function takes times [s]
that increase and returns one row of coordinates per time. tests/docs/test_benchmarks.py compares them with published values.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

G = 9.81


def integrate(rates, start, times, method="DOP853", atol=1e-12):
    """States at the times, one row each."""
    times = np.asarray(times, dtype=float)
    done = solve_ivp(rates, (0.0, times[-1]), start, method, t_eval=times, rtol=1e-12, atol=atol)
    return done.y.T


def pendulum(times):
    """A01: 1 kg on a massless rod of 1 m, let go from (-1, 0): sin(p / 2) = k sn(K - w t) with k = sin(45 degrees)."""
    w, m = math.sqrt(G), 0.5
    sn, _, dn, _ = ellipj(ellipk(m) - w * np.asarray(times), m)
    sine = math.sqrt(m) * sn  # of half the angle from the vertical; its cosine is dn
    return np.column_stack((-2.0 * sine * dn, 2.0 * sine ** 2 - 1.0))


def four_bars(times, windows=2):
    """A02: B0 of a row of four-bar windows, all rods of 1 m and 1 kg; the N + 1 uprights turn alike, the N couplers translate.

    I p'' = M g sin p with I = (N + 1) / 3 + N and M = (N + 1) / 2 + N [kg m2, kg m], from p = 0 at the top with p' = 1 rad/s. With
    b the rate at the bottom, b^2 = 1 + 4 M g / I, half the angle from the bottom is am(b t / 2 - K).
    """
    inertia, moment = (windows + 1) / 3.0 + windows, (windows + 1) / 2.0 + windows
    bottom = 1.0 + 4.0 * moment * G / inertia
    m = (bottom - 1.0) / bottom
    sn, cn, _, _ = ellipj(0.5 * math.sqrt(bottom) * np.asarray(times) - ellipk(m), m)
    return np.column_stack((-2.0 * sn * cn, 2.0 * sn ** 2 - 1.0))


# A03, Andrews' squeezing mechanism: lengths [m], masses [kg], moments of inertia about the centres of mass [kg m2], as in the
# Test Set for IVP Solvers. The bodies are the crank OF, the rod FE, the triangle BDE, EG, AG, EH and AH.
SQUEEZER = {
    "masses": (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498),
    "inertias": (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5),
    "a": complex(-0.06934, -0.00227), "b": complex(-0.03635, 0.03273), "c": complex(0.014, 0.072),
    "of": 0.007, "fe": 0.028, "be": 0.035, "eg": 0.02, "ag": 0.04, "eh": 0.02, "ah": 0.04,
    "stiffness": 4530.0, "rest": 0.07785, "torque": 0.033,
    # Angles of the bodies' own x axes: from O to F, E to F, B to E, G to E, A to G, H to E and A to H.
    "start": (-0.0617138900142764496, -0.0617138900142764496, 0.455279819163070380 - 0.5 * math.pi,
              0.222668390165885884674 + 0.487364979543842550 - 0.5 * math.pi, 0.487364979543842550,
              -0.222668390165885884674 + 1.23054744454982119, 1.23054744454982119 - 0.5 * math.pi),
}


class Squeezer:
    """Positions are sums of complex numbers r exp(i q) with the angles q of the seven bodies; the loops are such sums, too.

    M q'' = f + G^T l and G q'' = - (G' q') hold three loops of two rows. Two bodies meet at O, F, E, B, G, H and A.
    """

    def __init__(self):
        s = SQUEEZER
        self.masses, self.inertias = np.array(s["masses"]), np.array(s["inertias"])
        self.origins = np.array([0, 0, s["b"], s["a"], s["a"], s["a"], s["a"]])
        arms = np.zeros((7, 7), dtype=complex)  # of centre of mass b by the angle of body k
        arms[0, 0] = 0.00092
        arms[1, 0], arms[1, 1] = s["of"], -0.0115
        arms[2, 2] = complex(0.01874, 0.01043)
        arms[3, 4], arms[3, 3] = s["ag"], 0.00579
        arms[4, 4] = complex(0.02308, 0.00916)
        arms[5, 6], arms[5, 5] = s["ah"], 0.00579
        arms[6, 6] = complex(0.01228, -0.00449)
        self.arms = arms
        loops = np.zeros((3, 7), dtype=complex)  # point E by way of F, less by way of B, G and H
        loops[:, 0], loops[:, 1] = s["of"], -s["fe"]
        loops[0, 2] = -s["be"]
        loops[1, 3], loops[1, 4] = -s["eg"], -s["ag"]
        loops[2, 5], loops[2, 6] = -s["eh"], -s["ah"]
        self.loops = loops
        self.spring_arm = complex(0.018, 0.02)  # from B to D in the frame of BDE

    def rates(self, _, y):
        q, v = y[:7], y[7:]
        turn = np.exp(1j * q)
        moved = 1j * self.arms * turn  # velocity of each centre of mass per angular velocity
        mass = np.real(np.conj(moved).T @ (self.masses[:, None] * moved)) + np.diag(self.inertias)
        force = -np.real(np.conj(moved).T @ (self.masses * ((-self.arms * turn) @ (v * v))))
        force[0] += SQUEEZER["torque"]
        arm = self.spring_arm * turn[2]
        span = SQUEEZER["b"] + arm - SQUEEZER["c"]
        pull = -SQUEEZER["stiffness"] * (abs(span) - SQUEEZER["rest"]) / abs(span) * span
        force[2] += np.real(np.conj(1j * arm) * pull)
        closed = 1j * self.loops * turn
        gradient = np.vstack((closed.real, closed.imag))
        bias = (-self.loops * turn) @ (v * v)
        matrix = np.block([[mass, gradient.T], [gradient, np.zeros((6, 6))]])
        right = np.concatenate((force, -bias.real, -bias.imag))
        return np.concatenate((v, np.linalg.solve(matrix, right)[:7]))

    def energy(self, y):
        """Kinetic and elastic, less the work of the torque [J]."""
        q, v = y[:7], y[7:]
        turn = np.exp(1j * q)
        speeds = (self.arms * turn) @ v
        span = SQUEEZER["b"] + self.spring_arm * turn[2] - SQUEEZER["c"]
        return (0.5 * self.masses @ abs(speeds) ** 2 + 0.5 * self.inertias @ v ** 2
                + 0.5 * SQUEEZER["stiffness"] * (abs(span) - SQUEEZER["rest"]) ** 2 - SQUEEZER["torque"] * q[0])


def squeezer(times):
    """A03: the place of F, and the angle of the crank."""
    y = integrate(Squeezer().rates, list(SQUEEZER["start"]) + [0.0] * 7, times)
    return np.column_stack((SQUEEZER["of"] * np.cos(y[:, 0]), SQUEEZER["of"] * np.sin(y[:, 0]), y[:, 0]))


class Bricard:
    """A04: five rods of 1 m between six hinges, each axis normal to its rods and to the next axis.

    The turns of the hinges are a, b, a, b, a and b. The chain from the first hinge ends at the sixth, whose place and axis are fixed,
    if (1 + sin a)(1 + sin b) = 1. So a is a minimal coordinate with b(a); a is 0 at the start and 180 degrees where the motion
    turns back. Derivatives of the kinetic energy are taken by complex steps.
    """

    AXES = np.eye(3)[[1, 2, 0, 1, 2]]
    RODS = np.array([[1, 0, 0], [0, -1, 0], [0, 0, 1], [-1, 0, 0], [0, 1, 0]], dtype=float)
    ALONG, ACROSS = 0.02 / 12.0, 1.01 / 12.0  # moments of inertia of a rod of 1 kg with a section of 0.1 m x 0.1 m [kg m2]

    @staticmethod
    def turned(axis, angle, frame):
        cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        return frame @ (np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)

    @staticmethod
    def other(a):
        """b and db/da."""
        b = np.arcsin(-np.sin(a) / (1.0 + np.sin(a)))
        return b, -np.cos(a) / ((1.0 + np.sin(a)) ** 2 * np.cos(b))

    def chain(self, a):
        """Points, and for a rate 1 of a: velocities of the centres of mass, angular velocities, directions of the rods."""
        b, slope = self.other(a)
        frame, point, speed, spin = np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3)
        points, speeds, spins, rods = [point], [], [], []
        for i in range(5):
            angle, rate = ((a, 1.0), (b, slope))[i % 2]
            spin = spin + rate * (frame @ self.AXES[i])
            frame = self.turned(self.AXES[i], angle, frame)
            rod = frame @ self.RODS[i]
            speeds.append(speed + 0.5 * np.cross(spin, rod))
            speed, point = speed + np.cross(spin, rod), point + rod
            points.append(point)
            spins.append(spin)
            rods.append(rod)
        return points, speeds, spins, rods, frame

    def inertia(self, a):
        _, speeds, spins, rods, _ = self.chain(a)
        return sum(v @ v + self.ACROSS * (w @ w) + (self.ALONG - self.ACROSS) * (w @ r) ** 2
                   for v, w, r in zip(speeds, spins, rods))

    def rates(self, _, y):
        a, v = y
        slope = self.inertia(a + 1e-30j).imag / 1e-30
        weight = -G * sum(speed[1] for speed in self.chain(a)[1])
        return v, (weight - 0.5 * slope * v * v) / self.inertia(a)


def bricard(times):
    """A04: the place of P3, the end of the second rod."""
    one = Bricard()
    return np.array([one.chain(a)[0][2] for a in integrate(one.rates, [0.0, 0.0], times)[:, 0]])


class Governor:
    """A05: coordinates are the angle of both rods below the horizontal and the height s of the slider.

    The angular momentum about the shaft is constant, so the shaft's speed is L / J(angle).
    """

    ROD, SLIDER, BALL, SHAFT = 0.3, 3.0, 5.0, 0.3  # masses [kg]
    THIN = 0.01 ** 2 / 6.0  # a rod of section 0.01 m x 0.01 m, about its length, per mass [m2]
    ACROSS = (1.0 + 0.01 ** 2) / 12.0
    STIFFNESS, DAMPING, REST = 8e5, 4e4, 0.5

    def turning(self, angle):
        """J and dJ/d angle."""
        c, s = math.cos(angle), math.sin(angle)
        ball, middle = 0.05 + c, 0.05 + 0.5 * c
        value = (self.SHAFT * self.THIN + self.SLIDER * 0.1 ** 2 / 6.0
                 + 2.0 * (self.BALL * ball ** 2 + self.ROD * (middle ** 2 + self.ACROSS * c * c + self.THIN * s * s)))
        slope = 2.0 * (-2.0 * self.BALL * ball * s + self.ROD * (-middle * s + 2.0 * (self.THIN - self.ACROSS) * s * c))
        return value, slope

    def __init__(self):
        self.momentum = self.turning(math.radians(30.0))[0] * 2.0 * math.pi

    def spring(self, angle, s, rate, speed):
        """Force that draws the ends together, and the derivatives of the length by the angle and by s."""
        x, z = 0.5 * math.cos(angle), 1.0 - 0.5 * math.sin(angle) - s
        length = math.hypot(x, z)
        by_angle = (x * -0.5 * math.sin(angle) + z * -0.5 * math.cos(angle)) / length
        by_s = -z / length
        force = self.STIFFNESS * (length - self.REST) + self.DAMPING * (by_angle * rate + by_s * speed)
        return force, by_angle, by_s

    def rates(self, _, y):
        angle, s, rate, speed = y
        j, slope = self.turning(angle)
        force, by_angle, by_s = self.spring(angle, s, rate, speed)
        spin = self.momentum / j
        moment = 2.0 * (self.BALL + self.ROD * (0.25 + self.ACROSS))
        weight = 2.0 * G * (self.BALL + 0.5 * self.ROD) * math.cos(angle)
        turn = (0.5 * slope * spin ** 2 + weight - 2.0 * force * by_angle) / moment
        return rate, speed, turn, -G - 2.0 * force * by_s / self.SLIDER


def governor(times, method="Radau"):
    """A05: the height of the slider, and the angle of the rods."""
    y = integrate(Governor().rates, [math.radians(30.0), 0.5, 0.0, 0.0], times, method)
    return np.column_stack((y[:, 1], y[:, 0]))

"""Sliders for load and displacement, with the loop and the stress: streamlit run streamlit_app.py."""

import streamlit as st

import stickslip as ss

steel = ss.Body("210 GPa", 0.3)
load = st.slider("Load (N)", 1.0, 50.0, 10.0)
amplitude = st.slider("Displacement (nm)", 10.0, 500.0, 100.0)
ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], friction=0.3, normal_force=load)
ball.path([amplitude * 1e-9, -amplitude * 1e-9, amplitude * 1e-9])
st.metric("Stick radius", f"{ball.state.stick_radius * 1e6:.1f} µm")
st.pyplot(ball.plot().figure)
st.pyplot(ball.stress(200).plot().figure)

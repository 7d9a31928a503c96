<?xml version="1.0" encoding="utf-8"?>
<!-- Trait: an XDC gives values by actualValue, and a node ID -->
<!-- Reports: nothing -->
<ISO15745ProfileContainer xmlns="http://www.canopen.org/xml/1.1" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <ISO15745Profile>
    <ProfileHeader>
      <ProfileIdentification>CAN device profile</ProfileIdentification>
      <ProfileRevision>1</ProfileRevision>
      <ProfileName/>
      <ProfileSource/>
      <ProfileClassID>Device</ProfileClassID>
      <ISO15745Reference>
        <ISO15745Part>1</ISO15745Part>
        <ISO15745Edition>1</ISO15745Edition>
        <ProfileTechnology>CANopen</ProfileTechnology>
      </ISO15745Reference>
    </ProfileHeader>
    <ProfileBody xsi:type="ProfileBody_Device_CANopen" formatName="CANopen" formatVersion="1.0" fileName="configured.xdc" fileCreator="odkit" fileCreationDate="2026-11-26" fileCreationTime="09:30:00" fileVersion="1">
      <DeviceIdentity>
        <vendorName>odkit</vendorName>
        <vendorID>0x5F</vendorID>
        <productName>Valve</productName>
        <productID>0x5A</productID>
      </DeviceIdentity>
      <ApplicationProcess>
        <parameterList/>
      </ApplicationProcess>
    </ProfileBody>
  </ISO15745Profile>
  <ISO15745Profile>
    <ProfileHeader>
      <ProfileIdentification>CAN comm net profile</ProfileIdentification>
      <ProfileRevision>1</ProfileRevision>
      <ProfileName/>
      <ProfileSource/>
      <ProfileClassID>CommunicationNetwork</ProfileClassID>
      <ISO15745Reference>
        <ISO15745Part>1</ISO15745Part>
        <ISO15745Edition>1</ISO15745Edition>
        <ProfileTechnology>CANopen</ProfileTechnology>
      </ISO15745Reference>
    </ProfileHeader>
    <ProfileBody xsi:type="ProfileBody_CommunicationNetwork_CANopen" formatName="CANopen" formatVersion="1.0" fileName="configured.xdc" fileCreator="odkit" fileCreationDate="2026-11-26" fileVersion="1">
      <ApplicationLayers>
        <CANopenObjectList>
          <CANopenObject index="1000" name="Device type" objectType="7" dataType="0007" accessType="ro" defaultValue="0x00000000" PDOmapping="no"/>
          <CANopenObject index="1001" name="Error register" objectType="7" dataType="0005" accessType="ro" defaultValue="0" PDOmapping="no"/>
          <CANopenObject index="1017" name="Producer heartbeat time" objectType="7" dataType="0006" accessType="rw" defaultValue="0" actualValue="1000" PDOmapping="no"/>
          <CANopenObject index="1018" name="Identity object" objectType="9" subNumber="3">
            <CANopenSubObject subIndex="00" name="Highest sub-index supported" objectType="7" dataType="0005" accessType="ro" defaultValue="2" PDOmapping="no"/>
            <CANopenSubObject subIndex="01" name="Vendor-ID" objectType="7" dataType="0007" accessType="ro" defaultValue="0x5F" PDOmapping="no"/>
            <CANopenSubObject subIndex="02" name="Product code" objectType="7" dataType="0007" accessType="ro" defaultValue="0x5A" PDOmapping="no"/>
          </CANopenObject>
          <CANopenObject index="1400" name="RPDO1 communication parameter" objectType="9" subNumber="3">
            <CANopenSubObject subIndex="00" name="Highest sub-index supported" objectType="7" dataType="0005" accessType="ro" defaultValue="2" PDOmapping="no"/>
            <CANopenSubObject subIndex="01" name="COB-ID" objectType="7" dataType="0007" accessType="rw" defaultValue="$NODEID+0x200" PDOmapping="no"/>
            <CANopenSubObject subIndex="02" name="Transmission type" objectType="7" dataType="0005" accessType="rw" defaultValue="255" PDOmapping="no"/>
          </CANopenObject>
          <CANopenObject index="1600" name="RPDO1 mapping parameter" objectType="9" subNumber="2">
            <CANopenSubObject subIndex="00" name="Highest sub-index supported" objectType="7" dataType="0005" accessType="ro" defaultValue="1" PDOmapping="no"/>
            <CANopenSubObject subIndex="01" name="Entry 1" objectType="7" dataType="0007" accessType="rw" defaultValue="0x20010010" PDOmapping="no"/>
          </CANopenObject>
          <CANopenObject index="1800" name="TPDO1 communication parameter" objectType="9" subNumber="3">
            <CANopenSubObject subIndex="00" name="Highest sub-index supported" objectType="7" dataType="0005" accessType="ro" defaultValue="2" PDOmapping="no"/>
            <CANopenSubObject subIndex="01" name="COB-ID" objectType="7" dataType="0007" accessType="rw" defaultValue="$NODEID+0x180" PDOmapping="no"/>
            <CANopenSubObject subIndex="02" name="Transmission type" objectType="7" dataType="0005" accessType="rw" defaultValue="255" PDOmapping="no"/>
          </CANopenObject>
          <CANopenObject index="1A00" name="TPDO1 mapping parameter" objectType="9" subNumber="2">
            <CANopenSubObject subIndex="00" name="Highest sub-index supported" objectType="7" dataType="0005" accessType="ro" defaultValue="1" PDOmapping="no"/>
            <CANopenSubObject subIndex="01" name="Entry 1" objectType="7" dataType="0007" accessType="rw" defaultValue="0x20000010" PDOmapping="no"/>
          </CANopenObject>
          <CANopenObject index="2000" name="Measured value" objectType="7" dataType="0003" accessType="ro" defaultValue="0" PDOmapping="TPDO"/>
          <CANopenObject index="2001" name="Set point" objectType="7" dataType="0003" accessType="rw" defaultValue="0" PDOmapping="RPDO" lowLimit="-1000" highLimit="1000" actualValue="250"/>
        </CANopenObjectList>
        <dummyUsage>
          <dummy entry="Dummy0001=0"/>
          <dummy entry="Dummy0002=0"/>
          <dummy entry="Dummy0003=0"/>
          <dummy entry="Dummy0004=0"/>
          <dummy entry="Dummy0005=1"/>
          <dummy entry="Dummy0006=1"/>
          <dummy entry="Dummy0007=1"/>
        </dummyUsage>
      </ApplicationLayers>
      <TransportLayers>
        <PhysicalLayer>
          <baudRate defaultValue="250 Kbps">
            <supportedBaudRate value="125 Kbps"/>
            <supportedBaudRate value="250 Kbps"/>
            <supportedBaudRate value="500 Kbps"/>
          </baudRate>
        </PhysicalLayer>
      </TransportLayers>
      <NetworkManagement>
        <CANopenGeneralFeatures granularity="8" nrOfRxPDO="1" nrOfTxPDO="1" layerSettingServiceSlave="false"/>
        <deviceCommissioning NodeID="5" nodeName="valve 5" actualBaudRate="250 Kbps" networkNumber="1" networkName="line 1"/>
      </NetworkManagement>
    </ProfileBody>
  </ISO15745Profile>
</ISO15745ProfileContainer>
